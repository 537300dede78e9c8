#pragma once
#include <cstdint>
#include <span>

namespace galactic::simulation {

/// The range of heights of a robot's sphere centers, meters above its floor.
struct HeightsOverFloor {
  float lowest = 0;
  float highest = 0;
};

/// The height above the floor below which no sphere center of a radius ever lies, meters; 0 if
/// unknown, as for all radii if `lowest_of_radius` is empty.
[[nodiscard]] inline float lowestOver(std::span<const float> lowest_of_radius,
                                      std::uint32_t radius) {
  return radius < lowest_of_radius.size() ? lowest_of_radius[radius] : 0;
}

}  // namespace galactic::simulation
