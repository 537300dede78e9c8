#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "dynamics/episodes/robot_driver.h"
#include "dynamics/world.h"
#include "galactic/batch_simulator.h"
#include "galactic/error.h"
#include "galactic/world.h"
#include "run/learned_run.h"
#include "run/policy.h"

namespace galactic::dynamics {

/// Whose actions a closed loop carries out.
struct ClosedLoop {
  /// None: the scripted policy's. Must outlive the lanes.
  const OpenedPolicy* learned = nullptr;
  /// Whether a learned policy takes its likeliest actions.
  bool is_deterministic = false;
};

/// One env of the simulation, which plays one episode after the other, or follows a dynamics world
/// to provide a policy's observations in it and the end of the task. An episode depends only on
/// (world, options, episode), not on previous episodes. Not thread-safe, and not movable.
class EpisodeLane {
 public:
  /// `world` must outlive the lane. Only the task and the seed of `options` are used. `loop`: none
  /// if actions are given from outside. Fails with the errors of BatchSimulator::create and of the
  /// policies.
  [[nodiscard]] static Result<std::unique_ptr<EpisodeLane>> create(
      const World& world, const SimulationOptions& options, const std::optional<ClosedLoop>& loop);

  /// Begins an episode (index into the world's episodes) in which the robot can start. `arm`: what
  /// will move the joints.
  void begin(std::uint32_t episode, ArmDrive arm);

  /// The next actions of the policy. Fails as the policy does.
  [[nodiscard]] Result<std::span<const float>> act();

  /// One step of the simulation.
  void step(std::span<const float> actions);

  /// Follows a step of another world, with these actions, that led to `state`.
  void follow(std::span<const float> actions, const FollowedState& state);

  [[nodiscard]] const BatchSimulator& simulator() const { return simulator_; }
  [[nodiscard]] bool isDone() const { return simulator_.dones()[0] != 0; }
  [[nodiscard]] EpisodeEnd end() const { return simulator_.endings()[0]; }

 private:
  explicit EpisodeLane(BatchSimulator simulator);

  BatchSimulator simulator_;
  std::uint64_t seed_;
  std::unique_ptr<Policy> policy_;
  std::vector<float> actions_;
  std::uint64_t steps_ = 0;
};

/// Reads the state of a dynamics world after a step in the simulation's terms. Owns the memory to
/// which the result refers.
class WorldReading {
 public:
  /// `objects`: the number of objects in the env.
  [[nodiscard]] FollowedState read(const DynamicsWorld& world, const DrivenStep& driven,
                                   std::size_t objects);

 private:
  std::vector<float> positions_;
  std::vector<Pose> objects_;
};

}  // namespace galactic::dynamics
