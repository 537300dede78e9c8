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

/// What the simulation made of an action.
struct TracedStep {
  std::vector<float> actions;
  /// After it.
  Pose world_from_root;
  std::vector<float> positions;
  /// Index of an object of the episode, and where it is.
  std::optional<std::size_t> held;
  Pose world_from_held;
  /// The robot kept its pose; the robot was pushed clear.
  bool was_refused = false;
  bool has_slid = false;
};

/// An object that the hand let go of, and where the simulation put it.
struct TracedRelease {
  /// Number of the step.
  std::size_t step = 0;
  std::size_t object = 0;
  Pose world_from_object;
};

/// One episode of a recording from its start to its end in the simulation.
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

/// The start of an episode that env `env` is in.
[[nodiscard]] EpisodeTrace beginTrace(std::uint32_t env, const EnvState& state);

/// Adds a step to the episode. `was`, `is`: the env's statistics before and after it.
void extendTrace(EpisodeTrace& trace, std::span<const float> actions, const EnvState& after,
                 const SimulationStatistics& was, const SimulationStatistics& is);

/// World poses of the episode's objects after step `step`, also of the held one.
[[nodiscard]] std::vector<Pose> objectsAfter(const EpisodeTrace& trace, std::size_t step);

/// Steps the simulation through the recording and keeps its episodes, by env and then by time.
/// Episodes that the recording does not finish are left out. At most `most` of them, the first
/// ones; 0: all. Fails with the errors of the recording, of checkWorld and BatchSimulator::create,
/// and with kInvalidInput where a step of the simulation differs from the recorded one.
[[nodiscard]] Result<std::vector<EpisodeTrace>> tracesOf(RecordingReader& recording,
                                                         const World& world, std::size_t most);

}  // namespace galactic::dynamics
