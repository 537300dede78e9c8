// Which pairs of groups can touch, on robots made by hand and by chance.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <map>
#include <numbers>
#include <random>

#include "robot/robot_parts.h"

namespace galactic::test::self_collision_test {
namespace {

using bake::BakedPair;
using bake::BakedRobot;
using bake::classifyPairs;

/// A robot of spheres of radius 0.1 (index 1) and 0.05 m (index 0), each link a group of its own.
class BallRobot {
 public:
  BallRobot() { robot_.radii = {0.05F, 0.1F}; }

  /// A link on a revolute joint about Y at `offset` of its parent, with limits.
  BallRobot& link(int parent, Vec3 offset, PositionLimits limits, std::vector<SetSphere> spheres) {
    const auto index = static_cast<std::uint32_t>(robot_.groups.size());
    LinkFrame& frame = robot_.kinematics.links.emplace_back();
    frame.parent = parent;
    frame.parent_from_joint.translation = offset;
    frame.axis = {0, 1, 0};
    if (parent >= 0) {
      frame.type = JointType::kRevolute;
      frame.position = static_cast<std::int32_t>(robot_.kinematics.limits.size());
      robot_.kinematics.limits.push_back(limits);
      robot_.kinematics.start_positions.push_back((limits.lower + limits.upper) / 2);
    }
    bake::BakedGroup& group = robot_.groups.emplace_back();
    group.link = index;
    group.links = {index};
    group.spheres.spheres = std::move(spheres);
    return *this;
  }

  [[nodiscard]] BakedRobot& robot() { return robot_; }

 private:
  BakedRobot robot_;
};

std::vector<SetSphere> ballAt(Vec3 center) { return {{center, 1}}; }

PairKind kindOf(const std::vector<BakedPair>& pairs, int first, int second) {
  for (const BakedPair& pair : pairs) {
    if (pair.first == first && pair.second == second) return pair.kind;
  }
  ADD_FAILURE() << "no pair " << first << ", " << second;
  return PairKind::kTested;
}

constexpr PositionLimits kHalfTurns{-3.1F, 3.1F};

/// base - upper arm - forearm, each 0.5 m long; the forearm's tip can come back to the base.
BallRobot foldingArm() {
  BallRobot maker;
  maker.link(-1, {}, {}, ballAt({0, 0, 0}));
  maker.link(0, {0, 0, 0}, kHalfTurns, ballAt({0.25F, 0, 0}));
  maker.link(1, {0.5F, 0, 0}, kHalfTurns, ballAt({0.5F, 0, 0}));
  return maker;
}

TEST(SelfCollision, TestsAPairThatTouchesInSomePoses) {
  BallRobot maker = foldingArm();
  const auto pairs = classifyPairs(maker.robot(), {});
  ASSERT_EQ(pairs.size(), 3U);
  EXPECT_EQ(kindOf(pairs, 0, 1), PairKind::kAdjacent);
  EXPECT_EQ(kindOf(pairs, 1, 2), PairKind::kAdjacent);
  EXPECT_EQ(kindOf(pairs, 0, 2), PairKind::kTested);
}

TEST(SelfCollision, NeverTestsAPairThatLimitsKeepApart) {
  BallRobot maker = foldingArm();
  maker.robot().kinematics.limits[1] = {-1, 1};
  EXPECT_EQ(kindOf(classifyPairs(maker.robot(), {}), 0, 2), PairKind::kNever);
}

TEST(SelfCollision, NeverTestsAPairThatAlwaysTouches) {
  BallRobot maker;
  maker.link(-1, {}, {}, ballAt({0, 0, 0}));
  maker.link(0, {0, 0.05F, 0}, kHalfTurns, ballAt({0, 0, 0}));
  maker.link(1, {0, 0.05F, 0}, kHalfTurns, ballAt({0, 0, 0}));
  EXPECT_EQ(kindOf(classifyPairs(maker.robot(), {}), 0, 2), PairKind::kAlways);
}

TEST(SelfCollision, CountsTheStartPoseAmongTheSamples) {
  BallRobot maker = foldingArm();
  maker.robot().kinematics.limits[1] = {-1, 1};
  // Out of the limits on purpose: the only pose in which the tip reaches the base.
  maker.robot().kinematics.start_positions[1] = std::numbers::pi_v<float>;
  EXPECT_EQ(kindOf(classifyPairs(maker.robot(), {}), 0, 2), PairKind::kTested);
}

TEST(SelfCollision, LeavesOutPairsThatTheRecipeIgnoresUnlessTheyAreAdjacent) {
  BallRobot maker = foldingArm();
  const auto pairs = classifyPairs(maker.robot(), {{2, 0}, {0, 1}});
  EXPECT_EQ(kindOf(pairs, 0, 2), PairKind::kIgnored);
  EXPECT_EQ(kindOf(pairs, 0, 1), PairKind::kAdjacent);
}

TEST(SelfCollision, TakesGroupsJoinedThroughOneWithoutSpheresAsAdjacent) {
  BallRobot maker;
  maker.link(-1, {}, {}, ballAt({0, 0, 0}));
  maker.link(0, {0.1F, 0, 0}, kHalfTurns, {});
  maker.link(1, {0.1F, 0, 0}, kHalfTurns, ballAt({0, 0, 0}));
  const auto pairs = classifyPairs(maker.robot(), {});
  ASSERT_EQ(pairs.size(), 1U) << "none with the empty group";
  EXPECT_EQ(kindOf(pairs, 0, 2), PairKind::kAdjacent);
}

TEST(SelfCollision, TurnsJointsWithoutLimitsAllTheWay) {
  BallRobot maker = foldingArm();
  constexpr float kUnlimited = std::numeric_limits<float>::max();
  maker.robot().kinematics.limits[1] = {-kUnlimited, kUnlimited};
  EXPECT_EQ(kindOf(classifyPairs(maker.robot(), {}), 0, 2), PairKind::kTested);
}

TEST(SelfCollision, OfARobotWithoutSpheresHasNoPairs) {
  BallRobot maker;
  maker.link(-1, {}, {}, {}).link(0, {1, 0, 0}, kHalfTurns, {});
  EXPECT_TRUE(classifyPairs(maker.robot(), {}).empty());
}

/// Poses of the links of a BallRobot in a plane, in double precision: turns about Y only.
class PlaneChain {
 public:
  explicit PlaneChain(const BakedRobot& robot) : robot_(robot), poses_(robot.groups.size()) {}

  void pose(const std::vector<double>& angles) {
    for (std::size_t n = 0; n < poses_.size(); ++n) {
      const LinkFrame& link = robot_.kinematics.links[n];
      if (link.parent < 0) continue;
      const Pose2& parent = poses_[static_cast<std::size_t>(link.parent)];
      poses_[n] = at(parent, link.parent_from_joint.translation);
      poses_[n].angle = parent.angle + angles[static_cast<std::size_t>(link.position)];
    }
  }

  [[nodiscard]] bool touch(std::size_t a, std::size_t b) const {
    for (const SetSphere& p : robot_.groups[a].spheres.spheres) {
      for (const SetSphere& q : robot_.groups[b].spheres.spheres) {
        const Pose2 one = at(poses_[a], p.center);
        const Pose2 other = at(poses_[b], q.center);
        const double reach = static_cast<double>(robot_.radii[p.radius_index]) +
                             static_cast<double>(robot_.radii[q.radius_index]);
        if (std::hypot(one.x - other.x, one.y - other.y, one.z - other.z) < reach) return true;
      }
    }
    return false;
  }

 private:
  struct Pose2 {
    double x = 0, y = 0, z = 0, angle = 0;
  };

  static Pose2 at(const Pose2& frame, const Vec3& point) {
    const double c = std::cos(frame.angle);
    const double s = std::sin(frame.angle);
    const auto px = static_cast<double>(point.x);
    const auto pz = static_cast<double>(point.z);
    return {frame.x + c * px + s * pz, frame.y + static_cast<double>(point.y),
            frame.z - s * px + c * pz, frame.angle};
  }

  const BakedRobot& robot_;
  std::vector<Pose2> poses_;
};

TEST(SelfCollision, AgreesWithOtherSamplesOfRandomRobots) {
  constexpr std::uint32_t kSeed = 5;
  std::printf("seed %u\n", kSeed);
  std::mt19937 random(kSeed);
  const auto between = [&](double lower, double upper) {
    return lower + (upper - lower) * static_cast<double>(random()) * 0x1p-32;
  };
  std::map<PairKind, int> kinds;
  for (int round = 0; round < 20; ++round) {
    BallRobot maker;
    for (int n = 0; n < 6; ++n) {
      const int parent = n == 0 ? -1 : n - 1 - static_cast<int>(random() % 2 == 0 && n > 1);
      const auto f = [&](double reach) { return static_cast<float>(between(-reach, reach)); };
      const float turn = static_cast<float>(between(0.1, 3));
      maker.link(parent, {f(0.45), f(0.1), f(0.45)}, {-turn, turn},
                 {{{f(0.1), 0, 0}, 1}, {{0, f(0.1), 0}, 0}});
    }
    const auto pairs = classifyPairs(maker.robot(), {});
    PlaneChain chain(maker.robot());
    std::vector<int> touches(pairs.size());
    constexpr int kSamples = 2000;
    for (int sample = 0; sample < kSamples; ++sample) {
      std::vector<double> angles;
      for (const PositionLimits& limits : maker.robot().kinematics.limits) {
        angles.push_back(
            between(static_cast<double>(limits.lower), static_cast<double>(limits.upper)));
      }
      chain.pose(angles);
      for (std::size_t n = 0; n < pairs.size(); ++n) {
        touches[n] += static_cast<int>(chain.touch(pairs[n].first, pairs[n].second));
      }
    }
    // What 4000 samples have not seen is rarer than this in 2000 others.
    constexpr int kRare = kSamples / 200;
    for (std::size_t n = 0; n < pairs.size(); ++n) {
      ++kinds[pairs[n].kind];
      EXPECT_TRUE(pairs[n].kind != PairKind::kNever || touches[n] <= kRare) << touches[n];
      EXPECT_TRUE(pairs[n].kind != PairKind::kAlways || touches[n] >= kSamples - kRare)
          << touches[n];
    }
  }
  const int all = 20 * 15;
  for (const PairKind kind : {PairKind::kTested, PairKind::kAdjacent, PairKind::kNever}) {
    EXPECT_GT(kinds[kind], all / 10) << static_cast<int>(kind);
  }
  EXPECT_GT(kinds[PairKind::kAlways], 0);
  EXPECT_LT(kinds[PairKind::kTested], all * 9 / 10);
}

}  // namespace
}  // namespace galactic::test::self_collision_test
