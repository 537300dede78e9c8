#include "simulation/state/model.h"

#include <algorithm>
#include <cstdint>
#include <span>

namespace galactic::simulation {

std::size_t Model::bytes() const {
  return clearance.bytes() + slices.bytes() + level_floors.bytes() + laser.bytes() +
         geodesic.bytes() + std::span(starts).size_bytes() +
         std::span(start_variables).size_bytes() + std::span(start_bodies).size_bytes() +
         std::span(start_bounds).size_bytes() + std::span(start_boxes).size_bytes();
}

OptionalIndex Model::startOf(std::int64_t episode) const noexcept {
  if (episode < 0) return {};
  const auto start = std::ranges::lower_bound(starts, episode, {}, [](const EpisodeStart& one) {
    return static_cast<std::int64_t>(one.episode);
  });
  if (start == starts.end() || start->episode != episode) return {};
  return static_cast<std::uint32_t>(start - starts.begin());
}

}  // namespace galactic::simulation
