#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "galactic/scene.h"
#include "simulation/collision/clearance_kernels.h"
#include "simulation/collision/heights_over_floor.h"

namespace galactic::simulation {

/// The map of one floor and radius: see ClearanceLanes.
struct RadiusClearance {
  float min_x = 0, min_z = 0;
  float inverse_step = 0;
  float steps_x = 0, steps_z = 0;
  float lowest = 0, low = 0, highest = 0;
  float band_from = 0, inverse_band = 0;
  std::int32_t tiles_x = 0;
  std::int32_t band_cells = 0;
  /// Plane by plane, and tile by tile in each.
  std::vector<RoomAround> cells;
};

/// The maps of one floor, one per radius.
using FloorClearance = std::vector<RadiusClearance>;

/// Makes the maps of a floor. `floor`: its lowest height, meters; the robot's centers are `heights`
/// above it, or above parts of the floor up to `unevenness` higher. `lowest_of_radius`: see
/// lowestOver().
[[nodiscard]] FloorClearance makeFloorClearance(const Scene& scene, float floor, float unevenness,
                                                const HeightsOverFloor& heights,
                                                std::span<const float> lowest_of_radius = {});

/// The number of cells of all radii in these maps.
[[nodiscard]] std::size_t clearanceCells(const Scene& scene);

}  // namespace galactic::simulation
