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

/// Saves the states of some envs as bytes, little-endian: a header of 64 bytes (magic "GALSTATE",
/// version, counts, the world's hash, and a hash of header and all that follows), the options as
/// lines "name=value", and for each env everything that later steps depend on and that the last
/// step returned. Data that follows from these (bounds of resting objects, observations) is not
/// saved. `steps`: how many the simulator has made.
[[nodiscard]] std::vector<std::byte> saveEnvs(const Model& model, const BatchState& state,
                                              std::span<const std::uint32_t> envs,
                                              std::uint64_t steps);

/// Describes what is wrong with the number of steps that an env has made in its episode, in a state
/// from any source; empty if nothing is.
[[nodiscard]] std::string faultOfStep(const Model& model, std::uint32_t step);

/// One env of a saved state, checked.
struct SavedEnv {
  /// Indices and numbers; reach, transport and what follows from the episode are not saved.
  Env env;
  EnvCounters counters;
  MoveCounters moves;
  Held held;
  Vec3 goal;
  Vec3 target_start;
  Vec3 base;
  float yaw = 0;
  /// Where the robot believes to be; only with odometry.
  PlanarPose believed;
  GripFrame grip{};
  float reward = 0;
  EpisodeEnd ending = EpisodeEnd::kNone;
  /// Env::has_picked of the episode that the last step ended; `env` has that of the current one.
  bool had_picked = false;
  bool is_idle = false;
  std::vector<float> variables;
  std::vector<float> last_actions;
  /// The actions of Model::keptSteps() steps, one after another. Empty if nothing was asked for.
  std::vector<float> kept_actions;
  std::vector<std::uint64_t> ignored;
  std::vector<std::uint64_t> leaving;
  std::vector<Pose> objects;
  /// Empty if it was saved without bodies.
  std::vector<RigidTransform> bodies;
  /// Empty unless an episode ended.
  std::vector<float> final_observation;
};

struct SavedState {
  std::uint64_t seed = 0;
  std::uint64_t steps = 0;
  std::vector<SavedEnv> envs;
};

/// Makes env `n` go on from `saved`, whose vectors must have the sizes that `model` needs. Defined
/// in restoring.cpp.
void restoreEnv(const Model& model, BatchState& state, std::size_t n, const SavedEnv& saved);

/// Reads `bytes`, which may be anything. Fails with kUnsupported (another version) and
/// kInvalidInput (not a saved state, damaged, from another world or with other options, or with
/// values that no simulation leaves).
[[nodiscard]] Result<SavedState> readState(const Model& model, std::span<const std::byte> bytes);

}  // namespace galactic::simulation
