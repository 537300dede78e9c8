#pragma once
#include <cstddef>
#include <cstdint>

#include "galactic/pose.h"
#include "simulation/collision/resting_box.h"
#include "simulation/collision/sphere_batch.h"

namespace galactic::sensors {

/// Beams are cast eight at a time.
inline constexpr std::size_t kBeamLanes = simulation::kLanes;

/// A cell's byte c > 0 promises that no blocked cell comes within (c - 1) * kJump of any point in
/// it, in cells. Finer promises end sooner: a byte reaches 127 cells, 3.8 m of a usual grid.
inline constexpr float kJump = 0.5F;
/// How far a beam goes on beyond a border that it has come to, in cells: a hundredth of a
/// millimeter; far away, as a part of its way, so that rounding never leaves it where it was.
inline constexpr float kNudge = 1.0F / 1024;
inline constexpr float kNudgeOfWay = 0x1p-22F;
/// Bytes after the last cell that a look-up may read.
inline constexpr std::size_t kReadBeyond = 3;

/// A ScanPlane as bare pointers: the code built for AVX2 must not instantiate library templates,
/// which the linker could then share with code for any processor.
struct ScanPlaneView {
  /// Cell (i, k) at k * columns_x + i, the blocked ring included; kReadBeyond bytes follow.
  const std::uint8_t* cells = nullptr;
  std::int32_t columns_x = 0;
  std::int32_t columns_z = 0;
  /// Corner of the ring, world frame, and edge of a cell, meters.
  float min_x = 0;
  float min_z = 0;
  float spacing = 0;
  float inverse_spacing = 0;
};

/// The beams of one scan, which leave one point in a horizontal plane.
struct BeamBatch {
  /// World frame, meters.
  Vec3 origin;
  /// Of the yaw of the frame of the directions.
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

/// The kernels of a scan. Both versions do the same operations in the same order for each beam, and
/// none is contracted: they agree bit for bit.
struct ScanKernels {
  /// Writes for each beam the meters to where it enters a blocked cell of the plane, `range` when
  /// it does not get to one: exactly, but for kNudge at each border of a cell that it crosses.
  void (*cast_scene)(const ScanPlaneView&, const BeamBatch&, float* distances) noexcept = nullptr;
  /// Lowers the distance of each beam that meets the box to where it enters it; 0 from inside.
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
