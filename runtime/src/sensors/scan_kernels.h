#pragma once
#include <cstddef>
#include <cstdint>

#include "galactic/pose.h"
#include "simulation/collision/resting_box.h"
#include "simulation/collision/sphere_batch.h"

namespace galactic::sensors {

/// Beams are cast eight at a time.
inline constexpr std::size_t kBeamLanes = simulation::kLanes;

/// A cell whose byte is c > 0 has no blocked cell within (c - 1) * kJump of any of its points, in
/// cells. With a smaller unit a byte would not reach as far; with this one it reaches 127 cells,
/// 3.8 m in a usual grid.
inline constexpr float kJump = 0.5F;
/// How far a beam goes beyond the border of a cell that it has reached, in cells: a hundredth of a
/// millimeter. Far away it is the second number times the length of the beam so far, so that
/// rounding never leaves the beam where it was.
inline constexpr float kNudge = 1.0F / 1024;
inline constexpr float kNudgeOfWay = 0x1p-22F;
/// A look-up may read this many bytes beyond the last cell.
inline constexpr std::size_t kReadBeyond = 3;

/// A ScanPlane as bare pointers: code built for AVX2 must not instantiate library templates,
/// because the linker could then share them with code for any processor.
struct ScanPlaneView {
  /// Cell (i, k) at k * columns_x + i, the blocked ring included; kReadBeyond bytes follow.
  const std::uint8_t* cells = nullptr;
  std::int32_t columns_x = 0;
  std::int32_t columns_z = 0;
  /// Corner of the ring in the world frame, and edge of a cell, meters.
  float min_x = 0;
  float min_z = 0;
  float spacing = 0;
  float inverse_spacing = 0;
};

/// The beams of one scan, which start at one point of a horizontal plane and stay in it.
struct BeamBatch {
  /// World frame, meters.
  Vec3 origin;
  /// Cosine and sine of the yaw of the frame in which the directions are.
  float cosine = 1;
  float sine = 0;
  /// Unit directions in that frame: +X is ahead, +Z to the right. Shape: count, a multiple of
  /// kBeamLanes.
  const float* ahead = nullptr;
  const float* right = nullptr;
  std::size_t count = 0;
  /// Meters.
  float range = 0;
};

/// The kernels of a scan. Both versions do the same operations in the same order for each beam,
/// without contraction, so they agree bit for bit.
struct ScanKernels {
  /// Writes for each beam the distance at which it enters a blocked cell of the plane, meters, or
  /// `range` if it reaches none. The distance is exact apart from kNudge for each border of a cell
  /// that the beam crosses.
  void (*cast_scene)(const ScanPlaneView&, const BeamBatch&, float* distances) noexcept = nullptr;
  /// Lowers the distance of each beam that meets the box to where the beam enters the box; 0 if it
  /// starts inside.
  void (*cast_box)(const simulation::RestingBox&, const BeamBatch&,
                   float* distances) noexcept = nullptr;
};

/// For any processor.
[[nodiscard]] ScanKernels portableScan() noexcept;
/// For processors with AVX2.
[[nodiscard]] ScanKernels avx2Scan() noexcept;
/// The faster one that this processor can run.
[[nodiscard]] ScanKernels scanKernels() noexcept;

}  // namespace galactic::sensors
