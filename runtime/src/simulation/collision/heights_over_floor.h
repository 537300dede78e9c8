#pragma once
#include <cstdint>
#include <span>

namespace galactic::simulation {

/// Where a robot's sphere centers are over a floor, meters above it.
struct HeightsOverFloor {
  float lowest = 0;
  float highest = 0;
};

/// How far above its floor nothing of a radius is; 0 where nobody knows, as of all radii where
/// `lowest_of_radius` is empty.
[[nodiscard]] inline float lowestOver(std::span<const float> lowest_of_radius,
                                      std::uint32_t radius) {
  return radius < lowest_of_radius.size() ? lowest_of_radius[radius] : 0;
}

}  // namespace galactic::simulation
