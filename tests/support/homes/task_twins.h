#pragma once
#include <gtest/gtest.h>

#include <cstdint>
#include <stdexcept>
#include <vector>

#include "galactic/batch_simulator.h"
#include "support/homes/small_home.h"

namespace galactic::test {

inline BatchSimulator simulatorOf(const World& world, const SimulationOptions& options) {
  Result<BatchSimulator> simulator = BatchSimulator::create(world, options);
  if (!simulator) {
    throw std::runtime_error(simulator.error().text());
  }
  return std::move(*simulator);
}

/// A batch whose episodes end by the rules, and for each of its envs a twin that moves alike but
/// whose episodes never end by themselves: the twin still shows the state in which an episode
/// ended.
class TaskTwins {
 public:
  TaskTwins(const World& world, const SimulationOptions& options)
      : batch_(simulatorOf(world, options)) {
    twins_.reserve(options.envs);
    for (std::uint32_t env = 0; env < options.envs; ++env) {
      twins_.push_back(simulatorOf(world, endless(options, env)));
    }
  }

  [[nodiscard]] BatchSimulator& batch() { return batch_; }
  [[nodiscard]] std::size_t size() const { return twins_.size(); }

  /// After a step, before renew(): the state in which the step left the env.
  [[nodiscard]] EnvState after(std::size_t env) const { return twins_[env].envState(0); }

  [[nodiscard]] bool hasPicked(std::size_t env) const {
    return twins_[env].envObjects(0).has_picked;
  }

  void step(std::span<const float> actions) {
    batch_.step(actions);
    for (std::size_t env = 0; env < twins_.size(); ++env) {
      const auto row = actions.subspan(env * kSmallHomeActions, kSmallHomeActions);
      std::vector<float> calm(row.begin(), row.end());
      calm[kTerminate] = 0;
      twins_[env].step(calm);
    }
  }

  /// Begins the next episode of the twins whose env has done so.
  void renew() {
    for (std::size_t env = 0; env < twins_.size(); ++env) {
      if (batch_.dones()[env] == 0) continue;
      const auto episode = static_cast<std::int32_t>(batch_.envState(env).episode);
      const std::vector<float> nothing(kSmallHomeActions);
      twins_[env].step(nothing, std::span(&episode, 1));
    }
  }

 private:
  /// As env `env` of the batch, with a task that never ends: Rearrange without its failures where
  /// safe drops need its goal, else none.
  static SimulationOptions endless(SimulationOptions options, std::uint32_t env) {
    const bool is_safe_drop = options.task.kind == TaskKind::kRearrange && !options.task.drop_fails;
    options.task.kind = is_safe_drop ? TaskKind::kRearrange : TaskKind::kNone;
    options.task.needs_terminate = true;
    options.task.most_steps = 0;
    options.ranks = options.envs;
    options.rank = env;
    options.envs = 1;
    options.threads = 1;
    return options;
  }

  BatchSimulator batch_;
  std::vector<BatchSimulator> twins_;
};

inline void expectSameState(const EnvState& a, const EnvState& b) {
  EXPECT_EQ(a.scene, b.scene);
  EXPECT_EQ(a.episode, b.episode);
  EXPECT_EQ(a.step, b.step);
  EXPECT_EQ(a.world_from_root, b.world_from_root);
  EXPECT_EQ(a.joint_positions, b.joint_positions);
  EXPECT_EQ(a.world_from_grip, b.world_from_grip);
  EXPECT_EQ(a.objects, b.objects);
  EXPECT_EQ(a.held, b.held);
  EXPECT_EQ(a.target, b.target);
  EXPECT_EQ(a.goal, b.goal);
}

}  // namespace galactic::test
