#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "galactic/error.h"
#include "simulation/state/batch_state.h"
#include "simulation/state/model.h"

namespace galactic::simulation {

/// The states of some envs as bytes, little-endian: a header of 64 bytes (magic "GALSTATE",
/// version, counts, and hashes of world, options and all that follows), the options of the task as
/// lines "name=value", and env after env what later steps depend on and the last step returned.
/// What follows from these (grids of resting objects, observations) is not in it.
///
/// `steps`: of the simulator so far.
[[nodiscard]] std::vector<std::byte> saveEnvs(const Model& model, const BatchState& state,
                                              std::span<const std::uint32_t> envs,
                                              std::uint64_t steps);

/// What is wrong with the number of steps that an env has made in its episode, in a state that may
/// be anybody's; empty when nothing is.
[[nodiscard]] std::string faultOfStep(const Model& model, std::uint32_t step);

/// One env of a saved state, checked.
struct SavedEnv {
  /// Indices and figures; reach, transport and what the episode says are not saved.
  Env env;
  EnvCounters counters;
  MoveCounters moves;
  Held held;
  Vec3 goal;
  Vec3 target_start;
  Vec3 base;
  float yaw = 0;
  /// Where the robot takes itself to be; where there is odometry.
  PlanarPose believed;
  GripFrame grip{};
  float reward = 0;
  EpisodeEnd ending = EpisodeEnd::kNone;
  /// Of the episode that the last step ended; `env` has that of the one under way.
  bool had_picked = false;
  bool is_idle = false;
  std::vector<float> variables;
  std::vector<float> last_actions;
  /// Of Model::keptSteps() steps, one after the other. Empty: nothing was asked for.
  std::vector<float> kept_actions;
  std::vector<std::uint64_t> ignored;
  std::vector<std::uint64_t> leaving;
  std::vector<Pose> objects;
  /// Empty where it was saved without them.
  std::vector<RigidTransform> bodies;
  /// Empty unless an episode ended.
  std::vector<float> final_observation;
};

struct SavedState {
  std::uint64_t seed = 0;
  std::uint64_t steps = 0;
  std::vector<SavedEnv> envs;
};

/// Env `n` goes on from `saved`, whose parts have to be as long as `model` wants them: in
/// restoring.cpp.
void restoreEnv(const Model& model, BatchState& state, std::size_t n, const SavedEnv& saved);

/// What `bytes` hold, which may be anything. Fails with kUnsupported (another version) and
/// kInvalidInput (no state, damaged, of another world or of other options, or values that no
/// simulation leaves).
[[nodiscard]] Result<SavedState> readState(const Model& model, std::span<const std::byte> bytes);

}  // namespace galactic::simulation
