#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "galactic/bake/columns.h"

namespace galactic::bake {

/// Where a robot could stand in one connected part of the free space: in the middle of a square of
/// 80 cm, all of which is free for 1.2 m of height within the scene's bounds and has something
/// under it, whatever the radius of the spheres. Slabs, walls, cabinets and wardrobes have no such
/// places, however long they are.
struct StandingRoom {
  /// Under a roof, square meters.
  double roofed = 0;
  /// Under the sky.
  double open = 0;
};

/// Of each of `count` components. `component_of_span`: one for each span of `columns`.
[[nodiscard]] std::vector<StandingRoom> standingRoom(
    const Columns& columns, std::span<const std::uint32_t> component_of_span, std::uint32_t count);

}  // namespace galactic::bake
