#include "simulation/queries/checked_state.h"

#include <fmt/format.h>

#include <cstdint>
#include <string>

#include "simulation/state/env_state.h"
#include "support/call_check.h"

namespace galactic::simulation {

std::span<const Placement> checkedObjects(const char* call, const World& world,
                                          const EnvState& state) {
  detail::checkIndex(call, "scene", state.scene, world.scenes().size());
  detail::checkIndex(call, "episode", state.episode, world.episodes().episodes().size());
  const Episode& episode = world.episodes().episodes()[state.episode];
  const std::uint32_t scene = world.sceneIndexOf(episode);
  if (state.scene != scene) {
    detail::refuseCall(call, fmt::format("found scene {} and episode {}, which is in scene {}",
                                         state.scene, state.episode, scene));
  }
  detail::checkLength(call, "joint_positions", state.joint_positions.size(),
                      world.robot().positionCount());
  const std::span<const Placement> objects =
      world.episodes().presentOf(episode, state.objects.size()).placements;
  if (state.objects.size() != objects.size()) {
    detail::checkLength(call, "objects", state.objects.size(), episode.placement_count);
  }
  if (state.held < -1 || state.held >= static_cast<std::int64_t>(objects.size())) {
    detail::refuseCall(call, fmt::format("found held {}, expected -1 or an index below {}",
                                         state.held, objects.size()));
  }
  if (const std::string fault = faultOfNumbers(state); !fault.empty()) {
    detail::refuseCall(call, fmt::format("found a state that {}", fault));
  }
  return objects;
}

}  // namespace galactic::simulation
