#pragma once
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "galactic/batch_simulator.h"
#include "galactic/error.h"
#include "galactic/planning_scene.h"
#include "support/homes/small_home.h"
#include "support/homes/small_home_actor.h"
#include "support/homes/task_twins.h"

namespace galactic::test {

/// Far more steps than any part of the task takes.
inline constexpr int kPatience = 150;
/// Both answers of a question come up at least this often.
inline constexpr double kLeastShare = 0.1;

/// More than all else that a step pays.
inline constexpr float kKnockPenalty = 1000;

inline SimulationOptions oneEnv() {
  SimulationOptions options;
  options.envs = 1;
  options.threads = 1;
  options.order = EpisodeOrder::kLinear;
  options.task.most_steps = 0;
  options.task.knock_penalty = kKnockPenalty;
  // What is refused stays where it was.
  options.slide.attempts = 0;
  options.placement.attempts = 1;
  return options;
}

/// Poses of the small home's robot: everywhere in the room, joints within their limits.
class DrawnPoses {
 public:
  explicit DrawnPoses(std::uint32_t seed) : random_(seed) {}

  void add(std::size_t count) {
    for (std::size_t n = 0; n < count; ++n) {
      bases.push_back({{between(0.2F, 2.8F), 0, between(0.2F, 2.8F)}, between(-3, 3)});
      joints.insert(joints.end(),
                    {between(0, 0.8F), between(-3, 3), between(0, 0.6F), between(-1, 1)});
    }
  }
  [[nodiscard]] RobotPoses poses() const { return {bases, joints}; }
  [[nodiscard]] RobotPose operator[](std::size_t n) const {
    return {bases[n], std::span(joints).subspan(4 * n, 4)};
  }
  float between(float least, float most) {
    return std::uniform_real_distribution(least, most)(random_);
  }

  std::vector<BasePlace> bases;
  std::vector<float> joints;

 private:
  std::minstd_rand random_;
};

/// A simulator of one env, and the scene that is asked about it.
class PlanningSceneInTheSmallHome : public testing::Test {
 protected:
  PlanningSceneInTheSmallHome()
      : simulator_(simulatorOf(home_.world(), oneEnv())), scene_(home_.world(), oneEnv()) {
    look();
  }

  [[nodiscard]] EnvState state() const { return simulator_.envState(0); }
  void look() {
    const EnvState now = state();
    scene_.update(now);
    scene_.setJoints(now.joint_positions);
  }
  void step(const SmallHomeRow& row) {
    simulator_.step(row);
    look();
  }
  void fetchTarget() {
    for (int n = 0; n < kPatience && state().held < 0; ++n) step(fetch(state(), state().target));
    ASSERT_EQ(state().held, static_cast<std::int32_t>(state().target));
  }
  /// So many drawn poses in which the robot is free.
  [[nodiscard]] DrawnPoses freePoses(std::uint32_t seed, std::size_t count) {
    DrawnPoses drawn(seed);
    DrawnPoses free(0);
    while (free.bases.size() < count) {
      drawn.add(1);
      const RobotPose last = drawn[drawn.bases.size() - 1];
      scene_.setJoints(last.joints);
      if (!scene_.isFree(last.base)) continue;
      free.bases.push_back(last.base);
      free.joints.insert(free.joints.end(), last.joints.begin(), last.joints.end());
    }
    return free;
  }

  SmallHome home_;
  BatchSimulator simulator_;
  PlanningScene scene_;
};

/// Why a call is refused; empty where it is not.
inline std::string refusalOf(const std::function<void()>& call) {
  try {
    call();
  } catch (const ErrorException& refused) {
    EXPECT_EQ(refused.error().code, ErrorCode::kInvalidInput);
    return refused.error().text();
  }
  return {};
}

}  // namespace galactic::test
