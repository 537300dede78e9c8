#include "episode_table.h"

#include <array>
#include <cstdint>

#include "filled.h"

namespace galactic::python {

py::object episodeTableOf(const World& world) {
  const std::span<const Episode> episodes = world.episodes().episodes();
  const auto count = static_cast<py::ssize_t>(episodes.size());
  Filled<std::int32_t> scenes({count});
  Filled<float> bases({count, 4});
  Filled<std::int32_t> target_kinds({count});
  FilledPoses targets({count});
  FilledPoses goals({count});
  for (const Episode& episode : episodes) {
    const Placement& target = world.episodes().placements(episode)[episode.target];
    scenes.put(static_cast<std::int32_t>(world.sceneIndexOf(episode)));
    const auto& [x, y, z] = episode.base_position;
    bases.put(std::array{x, y, z, episode.base_yaw});
    target_kinds.put(static_cast<std::int32_t>(target.object));
    targets.put(target.pose);
    goals.put(episode.goal);
  }
  const auto poses = py::module_::import("galactic.env_states");
  return py::module_::import("galactic.episode_table")
      .attr("EpisodeTable")(scenes.array(), bases.array(), target_kinds.array(),
                            targets.poses(poses), goals.poses(poses));
}

}  // namespace galactic::python
