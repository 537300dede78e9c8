#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "galactic/scene.h"
#include "sensors/floor_plan.h"

namespace galactic::sensors {

/// A path along the floor to a point.
struct Way {
  /// Length of the path, meters; below 0 if there is none, or none is known.
  float distance = -1;
  /// Unit direction in which the path begins, world frame; (0, 0) if there is no path, or at its
  /// end.
  float x = 0;
  float z = 0;
};

/// The unit of the lengths in a field, meters, and the value that stands for "no path".
inline constexpr float kWayUnit = 1.0F / 512;
inline constexpr std::uint16_t kNoWay = 0xFFFF;

/// The length of the path to `point` (world frame) from the middle of each cell of a plan, in
/// kWayUnit, at most 127 m. A path leads over passable cells, then straight to the point. The
/// straight part starts in a cell within kLastLeg of the point from which the point is in sight
/// just above its own height; if there is no such cell, no path leads to the point. Lengths spread
/// by second-order fast marching (Sethian 1999), which is not bound to the directions of the
/// lattice. Cells beside the floor (kBeside) also have lengths, for bases that are nearer to
/// obstacles than the start pose can be. Shape: plan.cellCount().
[[nodiscard]] std::vector<std::uint16_t> wayField(const FloorPlan& plan, const Scene& scene,
                                                  const Vec3& point);

/// Like wayField(), but to a place on the floor where the base is to go: paths end in the cells
/// around it.
[[nodiscard]] std::vector<std::uint16_t> wayFieldToPlace(const FloorPlan& plan, const Vec3& place);

/// This many cells beside the floor have lengths too.
inline constexpr std::int32_t kBeside = 3;

/// How far the hand of a robot is assumed to reach from its base, across the floor, meters.
inline constexpr float kLastLeg = 1.25F;

/// The path from (x, z), interpolated from the four cells around it.
[[nodiscard]] Way wayFrom(const FloorPlan& plan, std::span<const std::uint16_t> field, float x,
                          float z) noexcept;

}  // namespace galactic::sensors
