#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "galactic/scene.h"
#include "sensors/floor_plan.h"

namespace galactic::sensors {

/// A way along the floor to a point.
struct Way {
  /// Meters; below 0: there is none, or none is known.
  float distance = -1;
  /// Unit direction in which it begins, world frame; (0, 0) without a way or at its end.
  float x = 0;
  float z = 0;
};

/// Lengths in a field, meters, and what stands for "no way".
inline constexpr float kWayUnit = 1.0F / 512;
inline constexpr std::uint16_t kNoWay = 0xFFFF;

/// The length of the way to `point` (world frame) from the middle of each cell of a plan, in
/// kWayUnit, at most 127 m. A way leads over passable cells, then straight to the point: from cells
/// within kLastLeg of it from which it is in sight just above its own height; where there is no
/// such cell, no way leads to it. Lengths spread by fast marching of second order (Sethian 1999),
/// which is not bound to the lattice's directions. Cells beside the floor (kBeside) have lengths
/// too, for bases that are nearer to things than the start pose can be. Shape: plan.cellCount().
[[nodiscard]] std::vector<std::uint16_t> wayField(const FloorPlan& plan, const Scene& scene,
                                                  const Vec3& point);

/// The same to a place on the floor, for the base: the way begins in the cells around it.
[[nodiscard]] std::vector<std::uint16_t> wayFieldToPlace(const FloorPlan& plan, const Vec3& place);

/// So many cells beside the floor have lengths, too.
inline constexpr std::int32_t kBeside = 3;

/// How far a hand that stands on the floor is taken to reach, meters.
inline constexpr float kLastLeg = 1.25F;

/// The way from (x, z), from the four cells around it.
[[nodiscard]] Way wayFrom(const FloorPlan& plan, std::span<const std::uint16_t> field, float x,
                          float z) noexcept;

}  // namespace galactic::sensors
