#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "galactic/batch_simulator.h"
#include "simulation/phases/chunk.h"
#include "simulation/simulator/saved_state.h"
#include "simulation/state/batch_state.h"
#include "simulation/state/model.h"

namespace galactic::simulation {

/// What is wrong with a state that need not be of this world; empty when nothing is.
[[nodiscard]] std::string faultOf(const Model& model, const EnvState& state);

/// Makes what envs go on from: of states that somebody has chosen, and of saved ones that lack the
/// robot's bodies.
class StateChooser {
 public:
  /// `model` must outlive it and stay where it is.
  explicit StateChooser(const Model& model);

  /// The state of an env: robot, objects, hand, step and goal as `chosen` says. The base goes to
  /// the floor under it, joints into their limits, and what is held follows the hand. Counters and
  /// what the last step returned are for the caller to fill in. None where no floor carries the
  /// base, where the robot penetrates the scene or a resting object that the hand could not have
  /// let go of there, or where the hand does not touch what it is to hold. `chosen`: without fault.
  [[nodiscard]] std::optional<SavedEnv> choose(const EnvState& chosen);

  /// Where the robot's bodies are in a saved state, to within the rounding of steps, which move
  /// bodies with a robot that slides.
  void addBodies(SavedEnv& saved);

 private:
  [[nodiscard]] ChunkStep step() { return {model_, state_, chunk_, 0}; }
  [[nodiscard]] bool touchesHeld(const EnvState& chosen) const;
  [[nodiscard]] bool standOnFloor(const EnvState& chosen);
  void setVariables(const EnvState& chosen);
  void fillHand(const EnvState& chosen);
  void leaveWhatIsInReach();
  [[nodiscard]] bool hasPicked(const EnvState& chosen) const;
  [[nodiscard]] SavedEnv taken(const EnvState& chosen);

  const Model& model_;
  /// Of the one env that is tried.
  BatchState state_;
  Chunk chunk_;
};

}  // namespace galactic::simulation
