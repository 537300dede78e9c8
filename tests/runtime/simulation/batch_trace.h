#pragma once
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "galactic/batch_simulator.h"
#include "support/homes/box_world.h"
#include "support/random_stream.h"

namespace galactic::test {

/// A room with walls, a table, a doorstep and a shelf; seven episodes with six cubes each. The
/// robot cannot start in episodes 2 (inside the table) and 5 (outside).
inline BoxWorld furnishedWorld(const RobotPackFields& robot = cartRobot()) {
  const std::vector<Block> blocks{plainFloor(),
                                  {{0, 0, 0}, {3, 2, 0.1F}},
                                  {{0, 0, 2.9F}, {3, 2, 3}},
                                  {{0, 0, 0}, {0.1F, 2, 3}},
                                  {{2.9F, 0, 0}, {3, 2, 3}},
                                  {{1.2F, 0, 1.2F}, {1.8F, 0.6F, 1.6F}},
                                  {{2, 0, 0}, {3, 0.03F, 3}},
                                  {{0, 0.5F, 2.5F}, {1, 0.55F, 3}}};
  std::vector<Start> starts;
  starts.reserve(7);
  for (int n = 0; n < 7; ++n) {
    const float by = 0.03F * static_cast<float>(n);
    starts.push_back({.base = {0.6F + by, 0, 0.8F},
                      .yaw = 0.9F * static_cast<float>(n) - 3,
                      .objects = {{1, 0.2F, 0.9F - by},
                                  {0.4F, 0.2F, 1.2F},
                                  {1.4F, 0.6F, 1.4F},
                                  {2.2F, 0.03F, 0.8F + by},
                                  {2.5F, 0.03F, 2.4F},
                                  {0.5F, 0.55F, 2.7F}}});
  }
  starts[2].base = {1.5F, 0, 1.4F};
  starts[5].base = {5, 0, 1};
  return {blocks, robot, episodesFrom(starts)};
}

inline SimulationOptions optionsFor(std::uint32_t envs, std::uint32_t threads = 1) {
  SimulationOptions options;
  options.envs = envs;
  options.threads = threads;
  options.seed = 11;
  options.body_transforms = true;
  options.task.most_steps = 40;
  return options;
}

/// Actions that only (env of all ranks, step, action) decide; the hand keeps what it has for some
/// steps, and the robot seldom says that it is done.
inline void fillActions(std::uint32_t env, std::uint32_t step, std::span<float> row) {
  RandomStream random(99, env, 0, step);
  for (float& action : row) action = 2 * random.unit() - 1;
  RandomStream slow(98, env, 0, step / 16);
  row[row.size() - 2] = 2 * slow.unit() - 1;
  row[row.size() - 1] = random.unit() < 0.01F ? 1.0F : 0.0F;
}

inline std::vector<float> actionsFor(const BatchSimulator& simulator, std::uint32_t first_env,
                                     std::uint32_t step) {
  const std::size_t count = simulator.actionCount();
  std::vector<float> actions(simulator.envCount() * count);
  for (std::size_t env = 0; env < simulator.envCount(); ++env) {
    fillActions(first_env + static_cast<std::uint32_t>(env), step,
                std::span(actions).subspan(env * count, count));
  }
  return actions;
}

/// The bits of all that a simulator says, mixed to one number for each env.
class BatchTrace {
 public:
  explicit BatchTrace(const BatchSimulator& simulator) : hashes_(simulator.envCount()) {
    add(simulator);
  }

  /// What is there after a step.
  void add(const BatchSimulator& simulator) {
    for (std::size_t env = 0; env < hashes_.size(); ++env) addEnv(simulator, env);
  }

  [[nodiscard]] const std::vector<std::uint64_t>& hashes() const { return hashes_; }

 private:
  void addEnv(const BatchSimulator& simulator, std::size_t env) {
    std::uint64_t& hash = hashes_[env];
    const std::size_t size = simulator.observationSize();
    addAll(hash, simulator.observations().subspan(env * size, size));
    const bool is_done = simulator.dones()[env] != 0;
    if (is_done) addAll(hash, simulator.finalObservations().subspan(env * size, size));
    const float reward = simulator.rewards()[env];
    addAll(hash, std::span(&reward, 1));
    mixIn(hash, simulator.dones()[env] * 2U + simulator.successes()[env]);
    mixIn(hash, static_cast<std::uint32_t>(simulator.endings()[env]));
    mixIn(hash, simulator.picks()[env]);
    if (!simulator.bodyTransforms().empty()) {
      const std::size_t bodies = simulator.bodyCount();
      for (const RigidTransform& body : simulator.bodyTransforms().subspan(env * bodies, bodies)) {
        addAll(hash, std::bit_cast<std::array<float, 12>>(body));
      }
    }
    addState(hash, simulator.envState(env));
  }

  static void addState(std::uint64_t& hash, const EnvState& state) {
    mixIn(hash, state.scene);
    mixIn(hash, state.episode);
    mixIn(hash, state.step);
    mixIn(hash, static_cast<std::uint32_t>(state.held));
    mixIn(hash, state.target);
    addAll(hash, state.joint_positions);
    for (const Pose& pose : {state.world_from_root, state.world_from_grip, state.goal}) {
      addAll(hash, std::bit_cast<std::array<float, 7>>(pose));
    }
    for (const Pose& pose : state.objects) {
      addAll(hash, std::bit_cast<std::array<float, 7>>(pose));
    }
  }

  static void addAll(std::uint64_t& hash, std::span<const float> values) {
    for (const float value : values) mixIn(hash, std::bit_cast<std::uint32_t>(value));
  }
  static void mixIn(std::uint64_t& hash, std::uint32_t value) {
    hash = mix(hash ^ value) + 0x9E3779B97F4A7C15ULL;
  }

  std::vector<std::uint64_t> hashes_;
};

/// Traces of `steps` steps of a batch whose first env is `first_env` of all ranks.
inline std::vector<std::uint64_t> tracesOf(BatchSimulator& simulator, std::uint32_t steps,
                                           std::uint32_t first_env = 0) {
  BatchTrace trace(simulator);
  for (std::uint32_t step = 0; step < steps; ++step) {
    simulator.step(actionsFor(simulator, first_env, step));
    trace.add(simulator);
  }
  return trace.hashes();
}

}  // namespace galactic::test
