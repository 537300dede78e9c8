#include "galactic/kinematics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <numbers>
#include <random>
#include <vector>

#include "support/oracles/chain_oracle.h"
#include "support/sanitized.h"

namespace galactic::test::kinematics_test {
namespace {

/// Single precision along chains of a dozen links and a few meters.
constexpr double kLengthTolerance = 1e-5;
constexpr double kAngleTolerance = 1e-5;

constexpr std::array kTypes{JointType::kFixed,     JointType::kRevolute, JointType::kContinuous,
                            JointType::kPrismatic, JointType::kPlanar,   JointType::kFloating};

/// A random tree of a robot's size.
struct RandomTree {
  std::vector<LinkFrame> links;
  /// Farthest from 0 that each position goes: a turn, or half a meter.
  std::vector<float> reach;
  std::size_t mimics = 0;
};

class TreeMaker {
 public:
  explicit TreeMaker(std::uint32_t seed) : random_(seed) {}

  float between(float lower, float upper) {
    return lower + (upper - lower) * static_cast<float>(random_()) * 0x1p-32F;
  }

  Quat rotation() {
    Eigen::Vector4d q;
    do {
      for (int n = 0; n < 4; ++n) q[n] = static_cast<double>(between(-1, 1));
    } while (q.norm() > 1 || q.norm() < 0.1);
    q.normalize();
    return {static_cast<float>(q[0]), static_cast<float>(q[1]), static_cast<float>(q[2]),
            static_cast<float>(q[3])};
  }

  /// Any direction; every third one along an axis of the frame, as robots have them.
  Vec3 direction() {
    const auto choice = random_() % 9;
    if (choice < 3)
      return {choice == 0 ? 1.F : 0.F, choice == 1 ? -1.F : 0.F, choice == 2 ? 1.F : 0};
    const Eigen::Vector3d v = toEigen(rotation()) * Eigen::Vector3d::UnitY();
    return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
  }

  RandomTree tree() {
    RandomTree tree;
    const std::size_t count = 2 + random_() % 30;
    for (std::size_t n = 0; n < count; ++n) tree.links.push_back(link(n, tree));
    return tree;
  }

  std::vector<float> positionsOf(const RandomTree& tree) {
    std::vector<float> positions;
    for (const float reach : tree.reach) positions.push_back(between(-reach, reach));
    return positions;
  }

 private:
  LinkFrame link(std::size_t n, RandomTree& tree) {
    LinkFrame frame;
    frame.parent_from_joint = {{between(-0.3F, 0.3F), between(-0.3F, 0.3F), between(-0.3F, 0.3F)},
                               rotation()};
    frame.axis = direction();
    if (n == 0) return frame;
    // Near the end: chains grow long.
    const std::size_t back = std::min<std::size_t>(n, 1 + random_() % 3);
    frame.parent = static_cast<std::int32_t>(n - back);
    frame.type = kTypes[random_() % kTypes.size()];
    const std::uint32_t values = positionCount(frame.type);
    if (values == 0) return frame;
    const bool slides = frame.type == JointType::kPrismatic;
    if (values == 1 && !tree.reach.empty() && random_() % 4 == 0) {
      frame.position = static_cast<std::int32_t>(random_() % tree.reach.size());
      frame.multiplier = slides ? between(-0.1F, 0.1F) : between(-2, 2);
      frame.offset = slides ? between(-0.1F, 0.1F) : between(-1, 1);
      ++tree.mimics;
      return frame;
    }
    frame.position = static_cast<std::int32_t>(tree.reach.size());
    for (std::uint32_t value = 0; value < values; ++value) {
      const bool turns = values == 1 ? !slides : value == 2 && values == 3;
      tree.reach.push_back(turns ? std::numbers::pi_v<float> : 0.5F);
    }
    return frame;
  }

  std::mt19937 random_;
};

std::vector<OracleLink> oracleOf(const std::vector<LinkFrame>& links) {
  std::vector<OracleLink> oracle;
  for (const LinkFrame& link : links) {
    oracle.push_back({.parent_from_joint = toEigen(link.parent_from_joint),
                      .axis = toEigen(link.axis).normalized(),
                      .type = link.type,
                      .parent = link.parent,
                      .position = link.position,
                      .multiplier = static_cast<double>(link.multiplier),
                      .offset = static_cast<double>(link.offset)});
  }
  return oracle;
}

TEST(ForwardKinematics, AgreesWithADoubleChainOverRandomTreesOfAllJointTypes) {
  constexpr std::uint32_t kSeed = 20240614;
  std::printf("seed %u\n", kSeed);
  TreeMaker maker(kSeed);
  PoseDifference worst;
  std::array<std::size_t, kTypes.size()> seen{};
  std::size_t mimics = 0;
  std::size_t links = 0;
  for (int round = 0; round < (kIsSanitized ? 80 : 400); ++round) {
    const RandomTree tree = maker.tree();
    const std::vector<OracleLink> oracle = oracleOf(tree.links);
    for (const LinkFrame& link : tree.links) ++seen[static_cast<std::size_t>(link.type)];
    mimics += tree.mimics;
    links += tree.links.size();
    for (int vector = 0; vector < 8; ++vector) {
      const std::vector<float> positions = maker.positionsOf(tree);
      const Pose root{{maker.between(-2, 2), maker.between(-2, 2), maker.between(-2, 2)},
                      maker.rotation()};
      std::vector<Pose> poses(tree.links.size());
      forwardKinematics(tree.links, root, positions, poses);
      const auto wanted = oraclePoses(oracle, toEigen(root), positions);
      for (std::size_t n = 0; n < poses.size(); ++n) worst.add(poses[n], wanted[n]);
    }
  }
  EXPECT_LT(worst.translation, kLengthTolerance);
  EXPECT_LT(worst.rotation, kAngleTolerance);
  // Every type and mimics are among the links, each a tenth of them or more.
  for (const std::size_t count : seen) EXPECT_GT(count, links / 10);
  EXPECT_GT(mimics, links / 10);
  std::printf("%zu links, %zu mimics: %.2e m, %.2e rad\n", links, mimics, worst.translation,
              worst.rotation);
}

TEST(ForwardKinematics, PlacesASingleLinkWhereTheRootIs) {
  const LinkFrame root;
  const Pose world_from_root{{1, 2, 3}, {0, 1, 0, 0}};
  Pose pose;
  forwardKinematics({&root, 1}, world_from_root, {}, {&pose, 1});
  EXPECT_EQ(pose, world_from_root);
}

TEST(ForwardKinematics, TurnsAndSlidesAsTheAxisPoints) {
  std::vector<LinkFrame> links(3);
  links[1] = {.parent_from_joint = {{1, 0, 0}, {}},
              .axis = {0, 1, 0},
              .parent = 0,
              .position = 0,
              .type = JointType::kRevolute};
  links[2] = {.parent_from_joint = {{1, 0, 0}, {}},
              .axis = {1, 0, 0},
              .parent = 1,
              .position = 1,
              .type = JointType::kPrismatic};
  const std::vector<float> positions{std::numbers::pi_v<float> / 2, 0.5F};
  std::vector<Pose> poses(links.size());
  forwardKinematics(links, {}, positions, poses);
  // A quarter turn about +Y takes +X to -Z.
  EXPECT_NEAR(poses[2].translation.x, 1, 1e-6);
  EXPECT_NEAR(poses[2].translation.y, 0, 1e-6);
  EXPECT_NEAR(poses[2].translation.z, -1.5, 1e-6);
}

TEST(ForwardKinematics, TakesAFloatingQuaternionOfAnyLengthAndNoneAsNoRotation) {
  std::vector<LinkFrame> links(2);
  links[1].parent = 0;
  links[1].position = 0;
  links[1].type = JointType::kFloating;
  std::vector<Pose> poses(2);
  forwardKinematics(links, {}, std::vector<float>{1, 2, 3, 0, 5, 0, 0}, poses);
  EXPECT_EQ(poses[1], (Pose{{1, 2, 3}, {0, 1, 0, 0}}));
  forwardKinematics(links, {}, std::vector<float>{1, 2, 3, 0, 0, 0, 0}, poses);
  EXPECT_EQ(poses[1], (Pose{{1, 2, 3}, {0, 0, 0, 1}}));
}

TEST(TransposedJacobian, SaysHowPointsMoveOverRandomTreesOfAllJointTypes) {
  constexpr std::uint32_t kSeed = 99;
  constexpr double kStep = 1e-4;
  /// A difference quotient in double precision; the rest is that of floats in long chains.
  constexpr double kMoveTolerance = 1e-4;
  std::printf("seed %u\n", kSeed);
  TreeMaker maker(kSeed);
  std::size_t moving = 0;
  std::size_t asked = 0;
  for (int round = 0; round < (kIsSanitized ? 10 : 30); ++round) {
    const RandomTree tree = maker.tree();
    const std::vector<OracleLink> oracle = oracleOf(tree.links);
    std::vector<float> positions = maker.positionsOf(tree);
    const Pose root{{maker.between(-2, 2), maker.between(-2, 2), 0}, maker.rotation()};
    std::vector<Pose> poses(tree.links.size());
    forwardKinematics(tree.links, root, positions, poses);
    const std::size_t link = tree.links.size() - 1;
    const Vec3 own{maker.between(-0.2F, 0.2F), 0.1F, 0};
    const Vec3 direction = maker.direction();
    std::vector<float> moves(positions.size(), 7);
    applyTransposedJacobian(tree.links, positions, poses,
                            {static_cast<std::uint32_t>(link), poses[link] * own, direction},
                            moves);
    const auto along = [&](std::size_t position, float value) {
      std::vector<float> there = positions;
      there[position] = value;
      const auto pose = oraclePoses(oracle, toEigen(root), there)[link];
      return (pose * toEigen(own)).dot(toEigen(direction));
    };
    for (std::size_t n = 0; n < positions.size(); ++n) {
      const float before = positions[n] - static_cast<float>(kStep);
      const float after = positions[n] + static_cast<float>(kStep);
      const double quotient = (along(n, after) - along(n, before)) /
                              (static_cast<double>(after) - static_cast<double>(before));
      EXPECT_NEAR(static_cast<double>(moves[n]), quotient,
                  kMoveTolerance * (1 + std::abs(quotient)));
      moving += std::abs(quotient) > kMoveTolerance ? 1U : 0U;
      ++asked;
    }
  }
  EXPECT_GT(moving, asked / 10);
  EXPECT_LT(moving, asked * 9 / 10);
}

TEST(PlanarDirections, AreUnitVectorsAcrossTheAxis) {
  constexpr std::uint32_t kSeed = 7;
  std::printf("seed %u\n", kSeed);
  TreeMaker maker(kSeed);
  for (int round = 0; round < 1000; ++round) {
    const Vec3 axis = maker.direction();
    const PlanarDirections directions = planarDirections(axis);
    constexpr float kTolerance = 2e-6F;
    EXPECT_NEAR(dot(directions.first, directions.first), 1, kTolerance);
    EXPECT_NEAR(dot(directions.second, directions.second), 1, kTolerance);
    EXPECT_NEAR(dot(directions.first, axis), 0, kTolerance);
    EXPECT_NEAR(dot(directions.second, axis), 0, kTolerance);
    EXPECT_NEAR(dot(cross(axis, directions.first), directions.second), 1, kTolerance);
  }
}

}  // namespace
}  // namespace galactic::test::kinematics_test
