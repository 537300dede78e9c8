#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>

#include "galactic/world.h"
#include "simulation/phases/contacts.h"
#include "simulation/phases/episode_start.h"
#include "simulation/phases/hand.h"
#include "simulation/phases/move.h"
#include "simulation/simulator/model_making.h"

namespace galactic::test {

/// The model of one env without a task. The world has to live as long.
inline simulation::Model modelOfOne(const World& world) {
  SimulationOptions options;
  options.envs = 1;
  options.task.kind = TaskKind::kNone;
  Result<simulation::Model> model = simulation::makeModel(world, options);
  if (!model) throw std::runtime_error(model.error().text());
  return std::move(*model);
}

/// A robot in the first episode, which a test takes through the phases of a step itself.
class OneRobot {
 public:
  /// The model has to live as long.
  explicit OneRobot(const simulation::Model& model)
      : model_(model), state_(model, 1), chunk_(model) {
    for (std::size_t n = 0; n < state_.paddedCount(); ++n) {
      simulation::beginEpisode(model, state_, n, 0, EpisodeChoice::kNamed);
    }
  }

  [[nodiscard]] const simulation::Env& env() const { return state_.env(0); }
  [[nodiscard]] Vec3 base() const { return state_.base(0); }
  [[nodiscard]] simulation::Chunk& chunk() { return chunk_; }
  [[nodiscard]] simulation::BatchState& state() { return state_; }
  [[nodiscard]] const simulation::BatchState& state() const { return state_; }
  [[nodiscard]] const simulation::Model& model() const { return model_; }
  [[nodiscard]] simulation::ChunkStep step() { return {model_, state_, chunk_, 0}; }

  /// Puts the candidate to a place of the floor.
  void put(float x, float z) {
    noActions();
    simulation::proposePoses(step());
    const simulation::PoseArrays candidates = chunk_.candidates(0);
    std::fill_n(candidates.x, simulation::kChunk, x);
    std::fill_n(candidates.z, simulation::kChunk, z);
    simulation::followFloor(step());
    simulation::placeBodies(step());
  }

  /// Moves there. Whether nothing kept it away.
  bool move(float x, float z) {
    put(x, z);
    simulation::moveRobots(step());
    return base().x == x && base().z == z;
  }

  /// A step with these actions of the base, apart from the hand.
  void drive(float forward, float turn) {
    noActions();
    chunk_.action(afterJoints(kForward), 0) = forward;
    chunk_.action(afterJoints(kTurn), 0) = turn;
    simulation::proposePoses(step());
    simulation::followFloor(step());
    simulation::placeBodies(step());
    simulation::moveRobots(step());
  }

  /// The hand takes an object, which lies at `place`.
  void take(std::uint32_t object, const Vec3& place) {
    state_.setObjectPose(0, object, {place, {}});
    simulation::takeInHand(step(), 0, object);
  }

  /// What the hand holds is so far away from it now.
  void holdAt(const Vec3& away) {
    state_.held(0).grip_from_object.translation = away;
    simulation::measureHeld(simulation::heldModel(model_, env()), state_.held(0));
  }

  /// Lets go of an object that rested, at `place`. Whether the hand is empty.
  bool release(std::uint32_t object, const Vec3& place) {
    const Pose there{place, {}};
    state_.resting(0).remove(object);
    state_.env(0).held = static_cast<std::int32_t>(object);
    state_.held(0).grip_from_object = inverse(simulation::gripPose(state_.grip(0))) * there;
    // Where the object goes back to if it can rest nowhere.
    state_.setObjectPose(0, object, there);
    simulation::measureHeld(simulation::heldModel(model_, env()), state_.held(0));
    noActions();
    chunk_.action(afterJoints(kHand), 0) = -1;
    simulation::useHands(step());
    return env().held < 0;
  }

 private:
  /// The actions that follow those of the joints.
  enum Action : std::uint8_t { kForward, kTurn, kHand };

  [[nodiscard]] std::size_t afterJoints(Action action) const {
    return model_.motion.controlled.size() + action;
  }
  void noActions() { std::ranges::fill(chunk_.actions(), simulation::EnvRow{}); }

  const simulation::Model& model_;
  simulation::BatchState state_;
  simulation::Chunk chunk_;
};

}  // namespace galactic::test
