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

/// Describes what is wrong with a state, which may be from another world; empty if nothing is.
[[nodiscard]] std::string faultOf(const Model& model, const EnvState& state);

/// Makes states that envs can go on from: out of states that a caller has chosen, and out of saved
/// ones without the robot's bodies.
class StateChooser {
 public:
  /// `model` must outlive it and stay where it is.
  explicit StateChooser(const Model& model);

  /// Makes the state of an env: robot, objects, hand, step and goal are those of `chosen`. The base
  /// is put on the floor under it, joints are clamped to their limits, and a held object follows
  /// the hand. The caller has to fill in the counters and what the last step returned. None if no
  /// floor carries the base, if the robot penetrates the scene or a resting object that the hand
  /// could not have let go of there, or if the hand does not touch the object that it is to hold.
  /// `chosen` must have no fault (faultOf()).
  [[nodiscard]] std::optional<SavedEnv> choose(const EnvState& chosen);

  /// Adds the poses of the robot's bodies to a saved state. They may differ by rounding from those
  /// of the simulation, which shifts bodies when a robot slides.
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
  /// The state of the one env that is tried.
  BatchState state_;
  Chunk chunk_;
};

}  // namespace galactic::simulation
