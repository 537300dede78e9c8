#pragma once
#include <cstdint>
#include <span>

#include "galactic/bake/source_episodes.h"
#include "galactic/error.h"
#include "galactic/object_set.h"
#include "galactic/robot.h"
#include "galactic/scene.h"

namespace galactic::bake {

struct EpisodeSamplerOptions {
  std::uint32_t episodes = 100;
  /// Objects per episode, the target among them.
  std::uint32_t objects = 10;
  std::uint64_t seed = 1;
  /// Heights above the floor between which objects and goals are placed, metres.
  float lowest = 0.3F;
  float highest = 1.2F;
  /// Shortest distance of target and goal, metres.
  float least_distance = 1.0F;
};

/// Draws episodes: objects in stable poses on what the column grids show to be flat and free, the
/// robot on the floor where neither it nor its start pose penetrates anything, target and goal
/// within reach of a place that the robot's base can drive to. Deterministic. Fails with
/// kInvalidInput, saying what was tried, when no such place is found.
[[nodiscard]] Result<SourceEpisodes> sampleEpisodes(std::span<const Scene> scenes,
                                                    const ObjectSet& objects, const Robot& robot,
                                                    const EpisodeSamplerOptions& options);

}  // namespace galactic::bake
