// Arms that slide: a lift and a telescope that leaves the base sideways, with and without a wrist.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <numbers>
#include <optional>
#include <random>
#include <vector>

#include "galactic/batch_simulator.h"
#include "scripted/inverse_kinematics.h"
#include "scripted/reach_table.h"
#include "scripted/scripted_policy.h"
#include "scripted_world.h"
#include "telescope_robot.h"

namespace galactic::test::telescope_test {
namespace {

using scripted::Arm;
using scripted::HandGoal;
using scripted::Joints;
using scripted::Movers;
using scripted::ReachTable;
using scripted::ReachView;

constexpr float kPi = std::numbers::pi_v<float>;
constexpr std::uint32_t kSamples = 20000;

float lengthOf(const Vec3& v) { return std::sqrt(dot(v, v)); }

/// `v` turned about +Y.
Vec3 turned(const Vec3& v, float angle) {
  return {std::cos(angle) * v.x + std::sin(angle) * v.z, v.y,
          std::cos(angle) * v.z - std::sin(angle) * v.x};
}

class Telescope {
 public:
  explicit Telescope(const TelescopeOptions& options = {})
      : pack_(buildPack(telescopeRobot(options)), "telescope"),
        robot_(MemoryPack::opened(Robot::from(pack_.pack()))),
        arm_(robot_),
        start_(robot_.startPositions().begin(), robot_.startPositions().end()) {}

  Arm& arm() { return arm_; }
  [[nodiscard]] const Joints& start() const { return start_; }

 private:
  MemoryPack pack_;
  Robot robot_;
  Arm arm_;
  Joints start_;
};

/// The grip worked out by hand: height of the lift, length of the telescope, turn of the base.
Vec3 gripAt(float lift, float length, float turn) {
  return turned({telescope::kAhead, telescope::kLowest + lift, length}, turn);
}

/// Every position of lift, telescope and base, a few millimeters apart.
class BruteForce {
 public:
  explicit BruteForce(float most_turn) {
    constexpr int kPieces = 60;
    const auto share = [](int n) { return static_cast<float>(n) / kPieces; };
    points_.reserve(static_cast<std::size_t>(kPieces + 1) * (kPieces + 1));
    for (int extent = 0; extent <= kPieces; ++extent) {
      const float length =
          telescope::kShortest + share(extent) * (telescope::kLongest - telescope::kShortest);
      for (int turn = 0; turn <= kPieces; ++turn) {
        points_.push_back(gripAt(0, length, (2 * share(turn) - 1) * most_turn));
      }
    }
  }

  /// From the nearest of all positions, meters.
  [[nodiscard]] float distance(const Vec3& place) const {
    // The lift takes the grip to any height by itself.
    const float height = std::clamp(place.y, telescope::kLowest, telescope::kHighest);
    float nearest = 1e9F;
    for (const Vec3& point : points_) {
      nearest = std::min(nearest, lengthOf(Vec3{point.x, height, point.z} - place));
    }
    return nearest;
  }

 private:
  std::vector<Vec3> points_;
};

TEST(Telescope, IsOneMoveOfItsSegmentsAndTheLiftAnother) {
  Telescope made({.segments = 4, .with_wrist = true});
  const auto joints = made.arm().joints();
  ASSERT_EQ(joints.size(), 6U);
  const std::array<std::uint32_t, 6> leaders{0, 1, 1, 1, 1, 5};
  for (std::size_t n = 0; n < joints.size(); ++n) EXPECT_EQ(joints[n].leader, leaders[n]) << n;

  RandomStream random(5, 0, 0, 0);
  Joints drawn = made.start();
  int long_or_short = 0;
  constexpr int kDraws = 400;
  for (int n = 0; n < kDraws; ++n) {
    made.arm().draw(random, drawn);
    for (std::size_t joint = 0; joint < joints.size(); ++joint) {
      EXPECT_GE(drawn[joint], joints[joint].lower);
      EXPECT_LE(drawn[joint], joints[joint].upper);
    }
    for (std::size_t segment = 2; segment < 5; ++segment) EXPECT_EQ(drawn[segment], drawn[1]);
    const float share = drawn[1] / joints[1].upper;
    if (share < 0.1F || share > 0.9F) ++long_or_short;
  }
  // One in five where lengths are even; one in five hundred were the segments drawn one by one.
  EXPECT_GT(long_or_short, kDraws / 10);
  EXPECT_LT(long_or_short, kDraws * 3 / 10);
}

TEST(Telescope, HasTheFreedomsOfItsJoints) {
  Telescope plain;
  Telescope wrist({.with_wrist = true});
  const auto freedoms = [](Telescope& made, Movers movers) {
    Joints joints = made.start();
    joints[1] = 0.1F;
    return handFreedoms(made.arm(), joints, movers);
  };
  EXPECT_EQ(freedoms(plain, Movers::kArm), 2);
  EXPECT_EQ(freedoms(plain, Movers::kArmAndTurnOfBase), 3);
  EXPECT_EQ(freedoms(wrist, Movers::kArm), 3);
  EXPECT_EQ(freedoms(wrist, Movers::kArmAndTurnOfBase), 4);
}

TEST(Telescope, ReachesToTheRightOfTheBase) {
  Telescope made;
  const ReachTable table(made.arm(), made.start(), kSamples);
  EXPECT_NEAR(table.bearing(), -kPi / 2, 1e-6F);
  const float farthest = std::hypot(telescope::kAhead, telescope::kLongest);
  EXPECT_LE(table.farthest(), farthest + 1e-5F);
  EXPECT_GE(table.farthest(), farthest - 1e-3F);
}

TEST(Telescope, ReachesWithTheBasesTurnWhatBruteForceReachesAndNothingElse) {
  constexpr float kMostTurn = 0.22F;
  // Half of the brute force's longest way between neighbors, with room; a place that is nearer to
  // none than the second is out of reach for certain.
  constexpr float kReached = 0.006F;
  constexpr float kUnreached = 0.012F;
  Telescope made;
  const ReachTable table(made.arm(), made.start(), kSamples);
  const ReachView view(table, {}, {1, 0, 0});
  const BruteForce brute(kMostTurn);
  scripted::InverseKinematicsOptions options;
  options.direction_tolerance = -1;
  std::mt19937 random(23);
  std::uniform_real_distribution<float> x(-0.3F, 0.5F);
  std::uniform_real_distribution<float> y(0.2F, 1.2F);
  std::uniform_real_distribution<float> z(0.2F, 1.0F);
  int reachable = 0;
  int unreachable = 0;
  int solved = 0;
  for (int n = 0; n < 600; ++n) {
    const HandGoal goal{.point = {}, .place = {x(random), y(random), z(random)}};
    const float distance = brute.distance(goal.place);
    if (distance > kReached && distance < kUnreached) continue;
    std::array<std::uint32_t, 3> seeds{};
    const std::size_t count = view.nearest(goal, 10.0F, seeds);
    ASSERT_EQ(count, seeds.size());
    std::optional<scripted::TurnedHand> hand;
    for (std::size_t seed = 0; seed < count && !hand; ++seed) {
      hand = solveHandAndTurn(made.arm(), goal, table.joints(made.arm(), seeds[seed], made.start()),
                              kMostTurn, options);
    }
    const bool is_reachable = distance <= kReached;
    ++(is_reachable ? reachable : unreachable);
    if (!hand) continue;
    EXPECT_TRUE(is_reachable) << distance;
    ++solved;
    EXPECT_LE(std::fabs(hand->turn), kMostTurn);
    const Joints& joints = hand->joints;
    for (std::size_t joint = 0; joint < joints.size(); ++joint) {
      EXPECT_GE(joints[joint], made.arm().joints()[joint].lower);
      EXPECT_LE(joints[joint], made.arm().joints()[joint].upper);
    }
    const float length = telescope::kShortest + joints[1] + joints[2] + joints[3];
    EXPECT_LE(lengthOf(gripAt(joints[0], length, hand->turn) - goal.place),
              options.tolerance + 1e-5F);
  }
  const int asked = reachable + unreachable;
  EXPECT_GT(reachable, asked / 10);
  EXPECT_GT(unreachable, asked / 10);
  // A place at the very edge may be missed by the damped steps.
  EXPECT_GE(solved, reachable * 95 / 100);
}

TEST(Telescope, KeepsTheBaseWhereOnlyTheArmMayMove) {
  Telescope made;
  const Joints seed{0.4F, 0.1F, 0.1F, 0.1F};
  scripted::InverseKinematicsOptions options;
  options.direction_tolerance = -1;
  const HandGoal ahead{.point = {}, .place = gripAt(0.5F, 0.7F, 0)};
  ASSERT_TRUE(solveHand(made.arm(), ahead, seed, options).has_value());
  const HandGoal beside{.point = {}, .place = gripAt(0.5F, 0.7F, 0.1F)};
  EXPECT_FALSE(solveHand(made.arm(), beside, seed, options).has_value());
  const auto with_turn = solveHandAndTurn(made.arm(), beside, seed, 0.22F, options);
  ASSERT_TRUE(with_turn.has_value());
  EXPECT_NEAR(with_turn->turn, 0.1F, 0.01F);
}

TEST(Telescope, TurnsTheHandWithTheBaseWhereItHasNoWristForThat) {
  // With a wrist about the vertical the base's turn leaves the direction in the plane free.
  Telescope made({.with_wrist = true});
  const ReachTable table(made.arm(), made.start(), kSamples);
  const ReachView view(table, {}, {1, 0, 0});
  std::mt19937 random(29);
  std::uniform_real_distribution<float> share(0.1F, 0.9F);
  std::uniform_real_distribution<float> turn(-0.2F, 0.2F);
  int solved = 0;
  constexpr int kCases = 100;
  for (int n = 0; n < kCases; ++n) {
    Joints wanted = made.start();
    for (std::size_t joint = 0; joint < wanted.size(); ++joint) {
      const auto& limits = made.arm().joints()[joint];
      wanted[joint] = limits.lower + share(random) * (limits.upper - limits.lower);
    }
    const float base = turn(random);
    const Pose grip = made.arm().gripOf(made.arm().placeLinks(wanted));
    const HandGoal goal{.point = {},
                        .direction = {1, 0, 0},
                        .place = turned(grip.translation, base),
                        .toward = turned(rotate(grip.rotation, {1, 0, 0}), base)};
    std::array<std::uint32_t, 3> seeds{};
    const std::size_t count = view.nearest(goal, 0.3F, seeds);
    for (std::size_t seed = 0; seed < count; ++seed) {
      const auto hand = solveHandAndTurn(
          made.arm(), goal, table.joints(made.arm(), seeds[seed], made.start()), 0.22F);
      if (!hand) continue;
      ++solved;
      const Pose reached = made.arm().gripOf(made.arm().placeLinks(hand->joints));
      EXPECT_LE(lengthOf(turned(reached.translation, hand->turn) - goal.place), 2.1e-3F);
      const Vec3 direction = turned(rotate(reached.rotation, {1, 0, 0}), hand->turn);
      EXPECT_LE(lengthOf(direction - goal.toward), 0.151F);
      break;
    }
  }
  EXPECT_GE(solved, kCases * 95 / 100);
}

/// A cube has to be carried from one end of a table to the other.
ScriptedWorld tableWorld(const RobotPackFields& robot, float height, float along) {
  MeshBuilder room = madeRoom(4, 4);
  room.box({1, 0, 3}, {3, height, 4});
  return stickWorld(room.build(), {1.2F, 0, 1.0F}, {1.3F, height + 0.001F, 3.2F},
                    {1.3F + along, height + 0.001F, 3.3F}, robot);
}

/// The steps of the episode, none where it was not solved.
std::optional<int> stepsOf(const World& world, SimulationOptions simulation) {
  simulation.envs = 1;
  simulation.threads = 1;
  BatchSimulator simulator = MemoryPack::opened(BatchSimulator::create(world, simulation));
  ScriptedPolicy policy = MemoryPack::opened(ScriptedPolicy::create(world, simulation));
  std::vector<float> actions(simulator.actionCount());
  for (int step = 1;; ++step) {
    policy.act(simulator, actions);
    simulator.step(actions);
    if (simulator.dones()[0] == 0) continue;
    if (simulator.successes()[0] != 0) return step;
    return std::nullopt;
  }
}

std::optional<int> stepsOnATable(const TelescopeOptions& options, float height, float along) {
  return stepsOf(tableWorld(telescopeRobot(options), height, along).world(), {});
}

TEST(ScriptedPolicyWithATelescope, CarriesACubeAlongATable) {
  int solved = 0;
  int played = 0;
  for (const bool with_wrist : {false, true}) {
    for (const float height : {0.4F, 0.6F, 0.8F}) {
      for (const float along : {0.4F, 1.2F}) {
        ++played;
        const auto steps = stepsOnATable({.with_wrist = with_wrist}, height, along);
        solved += steps.has_value() ? 1 : 0;
        EXPECT_TRUE(steps.has_value())
            << (with_wrist ? "with" : "without") << " a wrist, height " << height;
      }
    }
  }
  std::printf("%d of %d episodes solved\n", solved, played);
}

TEST(ScriptedPolicyWithATelescope, TurnsToWhereItReachesFromWhereMotionsAreOff) {
  SimulationOptions inexact;
  inexact.noise.motion = 0.1F;
  for (const float along : {0.4F, 1.2F}) {
    EXPECT_TRUE(stepsOf(tableWorld(telescopeRobot({}), 0.6F, along).world(), inexact)) << along;
  }
}

TEST(ScriptedPolicyWithATelescope, DoesNotPlanForeverWhereTurnsAreTooCoarseToArrive) {
  RobotPackFields robot = telescopeRobot({.with_wrist = false});
  robot.base->turn_step = 10;
  SimulationOptions inexact;
  inexact.noise.motion = 0.1F;
  const ScriptedWorld made = tableWorld(robot, 0.6F, 0.4F);
  int solved = 0;
  for (inexact.seed = 1; inexact.seed < 10; ++inexact.seed) {
    solved += stepsOf(made.world(), inexact) ? 1 : 0;
  }
  EXPECT_GT(solved, 0);
}

TEST(ScriptedPolicyWithATelescope, DoesTheSameEachTime) {
  const auto once = stepsOnATable({}, 0.6F, 1.2F);
  ASSERT_TRUE(once.has_value());
  EXPECT_EQ(stepsOnATable({}, 0.6F, 1.2F), once);
}

}  // namespace
}  // namespace galactic::test::telescope_test
