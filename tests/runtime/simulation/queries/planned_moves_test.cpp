// Moves of the robot in the small home that a PlanningScene is asked about before: whether they are
// free, and what is in their way.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <random>
#include <span>
#include <vector>

#include "galactic/planning_scene.h"
#include "runtime/simulation/queries/planned_home.h"

namespace galactic::test::planned_moves_test {
namespace {

class MovesInTheSmallHome : public PlanningSceneInTheSmallHome {
 protected:
  /// Makes a move that the scene is asked about before. Whether it is free.
  bool move(const SmallHomeRow& row) {
    const std::optional<BasePlace> base = proposed(row);
    const bool is_free = base && scene_.isFree(*base);
    const bool is_free_of_scene = base && scene_.isRobotFreeOfScene(*base);
    EXPECT_EQ(is_free, is_free_of_scene && scene_.isFreeOfAllElse(*base));
    const std::uint64_t refused = simulator_.statistics().refused;
    step(row);
    EXPECT_EQ(simulator_.statistics().refused == refused, is_free);
    // Whoever meets nothing but an object pays for it.
    const bool meets_object = is_free_of_scene && !is_free;
    EXPECT_EQ(simulator_.rewards()[0] < -kKnockPenalty / 2, meets_object);
    met_objects_ += meets_object ? 1 : 0;
    return is_free;
  }

  [[nodiscard]] int metObjects() const { return met_objects_; }

 private:
  /// The candidate: joints within their limits, the base on the floor that it gets to, if it does.
  std::optional<BasePlace> proposed(const SmallHomeRow& row) {
    const EnvState before = state();
    const Robot& robot = home_.world().robot();
    std::vector<float> joints = before.joint_positions;
    for (std::size_t n = 0; n < robot.controlledJoints().size(); ++n) {
      const ControlledJoint& joint = robot.controlledJoints()[n];
      joints[joint.position] =
          std::clamp(joints[joint.position] + joint.step * std::clamp(row[n], -1.0F, 1.0F),
                     joint.lower, joint.upper);
    }
    scene_.setJoints(joints);
    BasePlace base = scene_.baseOf(before);
    base.yaw -= robot.base()->turn_step * std::clamp(row[kTurn], -1.0F, 1.0F);
    const float ahead = robot.base()->forward_step * std::clamp(row[kForward], -1.0F, 1.0F);
    base.position = base.position + headingOf(base.yaw) * ahead;
    const auto floor = scene_.floorAt(base.position.x, base.position.z, base.position.y);
    if (!floor) return std::nullopt;
    base.position.y = *floor;
    return base;
  }

  int met_objects_ = 0;
};

TEST_F(MovesInTheSmallHome, AreAcceptedWhereTheSceneFindsThemFree) {
  std::minstd_rand random(2);
  std::uniform_real_distribution<float> number(-1, 1);
  constexpr int kMoves = 600;
  int accepted = 0;
  for (int n = 0; n < kMoves; ++n) {
    SCOPED_TRACE(n);
    // Long drives and reaches, so that the robot meets walls, table and objects.
    const bool drives = (n / 12) % 2 == 0;
    SmallHomeRow row{};
    if (drives) {
      row[n % 12 == 0 ? kTurn : kForward] = n % 12 == 0 ? number(random) * 100 : 1;
    } else {
      row[std::array{kLift, kShoulder, kArm}[static_cast<std::size_t>(n / 4 % 3)]] =
          number(random) * 100;
    }
    accepted += move(row) ? 1 : 0;
  }
  EXPECT_GE(accepted, kLeastShare * kMoves);
  EXPECT_LE(accepted, (1 - kLeastShare) * kMoves);
}

TEST_F(MovesInTheSmallHome, PayForObjectsThatAreInTheWay) {
  std::minstd_rand random(3);
  std::uniform_real_distribution<float> number(-1, 1);
  int free = 0;
  constexpr int kMoves = 300;
  for (int n = 0; n < kMoves; ++n) {
    SCOPED_TRACE(n);
    // The open hand goes to the target as if to fetch it, and into it.
    SmallHomeRow row = fetch(state(), state().target);
    row[kHand] = 0;
    for (float& action : std::span(row).first(kHand)) action += 0.3F * number(random);
    free += move(row) ? 1 : 0;
  }
  EXPECT_GE(free, kLeastShare * kMoves);
  EXPECT_GE(metObjects(), 10);
}

}  // namespace
}  // namespace galactic::test::planned_moves_test
