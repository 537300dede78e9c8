#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "galactic/batch_simulator.h"
#include "galactic/error.h"
#include "galactic/pose.h"
#include "galactic/world.h"
#include "run/recording.h"

namespace galactic::dynamics {

/// A step of the simulation: the actions and their result.
struct TracedStep {
  std::vector<float> actions;
  /// State after the step.
  Pose world_from_root;
  std::vector<float> positions;
  /// The held object, as an index among the episode's objects, and its pose.
  std::optional<std::size_t> held;
  Pose world_from_held;
  /// Whether the robot kept its pose, and whether it was pushed clear.
  bool was_refused = false;
  bool has_slid = false;
};

/// An object that the hand released, and where the simulation put it.
struct TracedRelease {
  /// Number of the step.
  std::size_t step = 0;
  std::size_t object = 0;
  Pose world_from_object;
};

/// One episode in the simulation, from its start to its end.
struct EpisodeTrace {
  std::uint32_t env = 0;
  /// Index into the world's scenes, and into its episodes.
  std::uint32_t scene = 0;
  std::uint32_t episode = 0;
  Pose start_root;
  std::vector<float> start_positions;
  /// World poses in the order of the episode's placements.
  std::vector<Pose> start_objects;
  std::size_t target = 0;
  Pose goal;
  std::vector<TracedStep> steps;
  std::vector<TracedRelease> releases;
  EpisodeEnd end = EpisodeEnd::kNone;
};

/// A trace of the episode in env `env`, with its start but no steps.
[[nodiscard]] EpisodeTrace beginTrace(std::uint32_t env, const EnvState& state);

/// Adds a step to the episode. `was`, `is`: the env's statistics before and after it.
void extendTrace(EpisodeTrace& trace, std::span<const float> actions, const EnvState& after,
                 const SimulationStatistics& was, const SimulationStatistics& is);

/// World poses of the episode's objects after step `step`, including the held one.
[[nodiscard]] std::vector<Pose> objectsAfter(const EpisodeTrace& trace, std::size_t step);

/// Steps the simulation through the recording and returns its finished episodes, ordered by env and
/// then by time: the first `most`, or all for 0. Fails with the errors of the recording, of
/// checkWorld and BatchSimulator::create, and with kInvalidInput if a step of the simulation
/// differs from the recorded one.
[[nodiscard]] Result<std::vector<EpisodeTrace>> tracesOf(RecordingReader& recording,
                                                         const World& world, std::size_t most);

}  // namespace galactic::dynamics
