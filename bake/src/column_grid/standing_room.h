#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "galactic/bake/columns.h"

namespace galactic::bake {

/// The area in which a robot could stand in one connected part of the free space: the middles of
/// squares of 80 cm that, whatever the radius of the spheres, are free over 1.2 m of height within
/// the scene's bounds and have something beneath. The insides of slabs, walls, cabinets and
/// wardrobes have no such area, however long they are.
struct StandingRoom {
  /// Under a roof, square meters.
  double roofed = 0;
  /// Under the sky.
  double open = 0;
};

/// The standing room of each of `count` components. `component_of_span`: the component of each span
/// of `columns`.
[[nodiscard]] std::vector<StandingRoom> standingRoom(
    const Columns& columns, std::span<const std::uint32_t> component_of_span, std::uint32_t count);

}  // namespace galactic::bake
