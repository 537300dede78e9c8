// Stable poses of shapes whose poses are known.
#include "fit/stable_poses.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numbers>
#include <random>
#include <thread>
#include <vector>

#include "fit_shapes.h"

namespace galactic::bake::stable_poses_test {
namespace {

constexpr std::uint32_t kSeed = 20250415;
/// The hull rounds corners to a ten-thousandth of the extent.
constexpr double kRounding = 1e-3;

Vec3 downOf(const StablePose& pose) { return rotate(conjugate(pose.rotation), {0, -1, 0}); }

double sumOf(const std::vector<StablePose>& poses) {
  double sum = 0;
  for (const StablePose& pose : poses) sum += static_cast<double>(pose.likelihood);
  return sum;
}

/// The object stands on the plane, no vertex below it, and likelihoods fall.
void expectValid(const std::vector<StablePose>& poses, std::span<const Vec3> points) {
  ASSERT_FALSE(poses.empty());
  ASSERT_LE(poses.size(), kMaxStablePoses);
  EXPECT_LE(sumOf(poses), 1 + 1e-6);
  for (std::size_t at = 0; at < poses.size(); ++at) {
    const StablePose& pose = poses[at];
    EXPECT_GT(pose.likelihood, 0);
    if (at > 0) {
      EXPECT_LE(pose.likelihood, poses[at - 1].likelihood + 2e-6F);
    }
    float lowest = 1e9F;
    for (const Vec3& point : points) {
      lowest = std::min(lowest, rotate(pose.rotation, point).y + pose.height);
    }
    EXPECT_GE(lowest, 0);
    EXPECT_LT(lowest, 1e-6F);
  }
}

/// The share of the sphere that a centered rectangle of these half sides covers at a distance.
double rectangleShare(double a, double b, double distance) {
  return std::atan(a * b / (distance * std::sqrt(distance * distance + a * a + b * b))) /
         std::numbers::pi;
}

/// The share of the sphere that a centered disc covers at a distance.
double discShare(double radius, double distance) {
  return (1 - distance / std::hypot(radius, distance)) / 2;
}

TEST(StablePoses, OfACubeAreItsSixFaces) {
  const auto points = test::cuboid({0.1F, 0.1F, 0.1F});
  const auto poses = findStablePoses(test::meshOf(points));
  expectValid(poses, points);
  ASSERT_EQ(poses.size(), 6U);
  for (const StablePose& pose : poses) {
    EXPECT_NEAR(static_cast<double>(pose.likelihood), 1.0 / 6, kRounding);
    EXPECT_NEAR(pose.height, 0.1F, 1e-5F);
  }
  EXPECT_EQ(poses[0].rotation, Quat{}) << "the upright pose comes first of equals";
}

TEST(StablePoses, OfATurnedCubeAreItsSixFacesToo) {
  std::mt19937 random(kSeed);
  RecordProperty("seed", static_cast<int>(kSeed));
  for (int run = 0; run < 30; ++run) {
    const Pose pose{{0.3F, 0.2F, -0.4F}, test::toQuat(test::randomRotation(random))};
    const auto points = test::moved(test::cuboid({0.1F, 0.1F, 0.1F}), pose);
    const auto poses = findStablePoses(test::meshOf(points));
    expectValid(poses, points);
    ASSERT_EQ(poses.size(), 6U);
    for (const StablePose& resting : poses) {
      EXPECT_NEAR(static_cast<double>(resting.likelihood), 1.0 / 6, kRounding);
      // Two of three parts vanish: a face of the cube, not tilted by the hull's rounding.
      const Vec3 down = rotate(conjugate(pose.rotation), downOf(resting));
      std::array parts{std::abs(down.x), std::abs(down.y), std::abs(down.z)};
      std::sort(parts.begin(), parts.end());
      EXPECT_LT(parts[1], 5e-6F);
    }
  }
}

TEST(StablePoses, OfAFlatBoxHaveTheSolidAnglesOfItsFaces) {
  const auto points = test::cuboid({0.2F, 0.02F, 0.1F});
  const auto poses = findStablePoses(test::meshOf(points));
  expectValid(poses, points);
  ASSERT_EQ(poses.size(), 6U);
  EXPECT_NEAR(sumOf(poses), 1, 1e-6);
  const std::array<double, 6> expected{
      rectangleShare(0.2, 0.1, 0.02), rectangleShare(0.2, 0.1, 0.02),
      rectangleShare(0.2, 0.02, 0.1), rectangleShare(0.2, 0.02, 0.1),
      rectangleShare(0.1, 0.02, 0.2), rectangleShare(0.1, 0.02, 0.2)};
  for (std::size_t at = 0; at < poses.size(); ++at) {
    EXPECT_NEAR(static_cast<double>(poses[at].likelihood), expected[at], kRounding);
  }
  EXPECT_EQ(poses[0].rotation, Quat{});
}

TEST(StablePoses, OfATetrahedronAreItsFourFaces) {
  const std::vector<Vec3> points{
      {0.1F, 0.1F, 0.1F}, {0.1F, -0.1F, -0.1F}, {-0.1F, 0.1F, -0.1F}, {-0.1F, -0.1F, 0.1F}};
  const auto poses = findStablePoses(test::meshOf(points));
  expectValid(poses, points);
  ASSERT_EQ(poses.size(), 4U);
  for (const StablePose& pose : poses) {
    EXPECT_NEAR(static_cast<double>(pose.likelihood), 0.25, kRounding);
    EXPECT_NEAR(static_cast<double>(pose.height), 0.1 / std::sqrt(3.0), 1e-5);
  }
}

TEST(StablePoses, OfACylinderAreItsEndsAndItsSides) {
  constexpr int kSides = 40;
  const auto points = test::lathe({{0.05, -0.03}, {0.05, 0.03}}, kSides);
  const auto poses = findStablePoses(test::meshOf(points));
  expectValid(poses, points);
  ASSERT_EQ(poses.size(), kMaxStablePoses) << "two ends and the first of 40 sides";
  const double end = discShare(0.05, 0.03);
  for (std::size_t at = 0; at < 2; ++at) {
    EXPECT_NEAR(static_cast<double>(poses[at].likelihood), end, 2e-3);
    EXPECT_NEAR(std::abs(downOf(poses[at]).y), 1, 1e-6F);
  }
  for (std::size_t at = 2; at < poses.size(); ++at) {
    EXPECT_NEAR(static_cast<double>(poses[at].likelihood), (1 - 2 * end) / kSides, 1e-3);
    EXPECT_NEAR(downOf(poses[at]).y, 0, 1e-5F);
  }
}

TEST(StablePoses, OfAConeAreItsBaseAndItsSides) {
  const auto points = test::lathe({{0.05, 0.0}, {0.0, 0.1}}, 40);
  const auto poses = findStablePoses(test::meshOf(points));
  expectValid(poses, points);
  EXPECT_NEAR(downOf(poses[0]).y, -1, 1e-6F);
  EXPECT_NEAR(static_cast<double>(poses[0].likelihood), discShare(0.05, 0.025), 2e-3);
  const double side_slope = 0.05 / std::hypot(0.05, 0.1);
  for (std::size_t at = 1; at < poses.size(); ++at) {
    EXPECT_NEAR(static_cast<double>(downOf(poses[at]).y), side_slope, 2e-3) << "never the apex";
  }
}

TEST(StablePoses, OfABowlAreUprightAndUpsideDown) {
  // A half ball with a flat foot; its hull is full.
  std::vector<test::Ring> rings;
  for (int ring = 2; ring <= 16; ++ring) {
    const double polar = std::numbers::pi / 2 * ring / 16;
    rings.push_back({0.1 * std::sin(polar), 0.1 - 0.1 * std::cos(polar)});
  }
  const auto points = test::lathe(rings, 48);
  const auto poses = findStablePoses(test::meshOf(points));
  expectValid(poses, points);
  ASSERT_EQ(poses.size(), 2U);
  EXPECT_NEAR(downOf(poses[0]).y, -1, 1e-6F);
  EXPECT_NEAR(downOf(poses[1]).y, 1, 1e-6F);
  // The center of a half ball is 3/8 of its radius below the rim; the foot shifts it little.
  EXPECT_NEAR(static_cast<double>(poses[1].likelihood), discShare(0.1, 0.0375), 0.01);
  EXPECT_NEAR(sumOf(poses), 1, 1e-6);
}

TEST(StablePoses, OfALeaningTowerDoNotStandOnItsFoot) {
  auto points = test::cuboid({0.02F, 0.2F, 0.02F});
  for (Vec3& point : points) point.x += 0.3F * point.y;
  const auto poses = findStablePoses(test::meshOf(points));
  expectValid(poses, points);
  ASSERT_FALSE(poses.empty());
  for (const StablePose& pose : poses) EXPECT_LT(std::abs(downOf(pose).y), 0.9F);
}

TEST(StablePoses, JoinPosesThatDifferLittle) {
  // A rocker of facets two degrees apart beneath a block: nine of them, one pose.
  std::vector<Vec3> points;
  for (int step = -4; step <= 4; ++step) {
    const double angle = 0.035 * step;
    for (const float z : {-0.05F, 0.05F}) {
      points.push_back({static_cast<float>(0.2 * std::sin(angle)),
                        static_cast<float>(-0.2 * std::cos(angle)), z});
    }
  }
  for (const float z : {-0.05F, 0.05F}) {
    points.push_back({-0.03F, -0.12F, z});
    points.push_back({0.03F, -0.12F, z});
  }
  const auto poses = findStablePoses(test::meshOf(points));
  expectValid(poses, points);
  const double same = std::cos(kSamePoseAngle);
  for (std::size_t a = 0; a < poses.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      EXPECT_LE(static_cast<double>(dot(downOf(poses[a]), downOf(poses[b]))), same + 1e-6);
    }
  }
  EXPECT_NEAR(sumOf(poses), 1, 1e-6);
}

/// A pack demands it of what is stored, and symmetric bodies have likelihoods that differ by
/// rounding.
TEST(StablePoses, AreStoredInDescendingLikelihood) {
  std::mt19937 random(kSeed);
  std::size_t close = 0;
  std::size_t all = 0;
  for (int sides = 6; sides < 60; ++sides) {
    SCOPED_TRACE(sides);
    std::vector<Vec3> body = test::lathe({{0.03, -0.05}, {0.03, 0.05}}, sides);
    body = test::moved(body, {{}, test::toQuat(test::randomRotation(random))});
    const std::vector<StablePose> poses = findStablePoses(test::meshOf(body));
    for (std::size_t n = 1; n < poses.size(); ++n) {
      EXPECT_LE(poses[n].likelihood, poses[n - 1].likelihood);
      ++all;
      if (poses[n].likelihood > 0.999F * poses[n - 1].likelihood) ++close;
    }
  }
  EXPECT_GT(close, all / 10);
  EXPECT_LT(close, all);
}

TEST(StablePoses, OfAFlatMeshAreItsTwoSides) {
  std::mt19937 random(kSeed);
  for (int run = 0; run < 20; ++run) {
    const Pose pose{{0.1F, 0.2F, 0.3F}, test::toQuat(test::randomRotation(random))};
    const auto points = test::moved(test::cuboid({0.1F, 0.2F, 0}), pose);
    const auto poses = findStablePoses(test::meshOf(points));
    expectValid(poses, points);
    ASSERT_EQ(poses.size(), 2U);
    for (const StablePose& resting : poses) {
      EXPECT_EQ(resting.likelihood, 0.5F);
      EXPECT_NEAR(std::abs(rotate(conjugate(pose.rotation), downOf(resting)).z), 1, 1e-5F);
    }
    EXPECT_LE(downOf(poses[0]).y, 0);
  }
}

TEST(StablePoses, OfALineLieAndOfAPointStayAsTheyAre) {
  const std::vector<Vec3> line{{0, 0, 0}, {0.1F, 0.2F, 0.3F}, {0.05F, 0.1F, 0.15F}};
  const auto lying = findStablePoses(test::meshOf(line));
  expectValid(lying, line);
  ASSERT_EQ(lying.size(), 4U);
  for (const StablePose& pose : lying) {
    EXPECT_EQ(pose.likelihood, 0.25F);
    EXPECT_NEAR(rotate(pose.rotation, line[1]).y, 0, 1e-6F);
  }
  const std::vector<Vec3> point(3, Vec3{0.1F, 0.2F, 0.3F});
  const auto still = findStablePoses(test::meshOf(point));
  expectValid(still, point);
  ASSERT_EQ(still.size(), 1U);
  EXPECT_EQ(still[0].rotation, Quat{});
  EXPECT_EQ(still[0].likelihood, 1);
  EXPECT_EQ(findStablePoses({}).size(), 1U);
}

TEST(StablePoses, IgnoreVerticesThatNoTriangleUses) {
  const auto points = test::cuboid({0.1F, 0.1F, 0.1F});
  TriangleMesh mesh = test::meshOf(points);
  const auto wanted = findStablePoses(mesh);
  mesh.vertices.push_back({5, 5, 5});
  const auto found = findStablePoses(mesh);
  ASSERT_EQ(found.size(), wanted.size());
  for (std::size_t n = 0; n < found.size(); ++n) {
    EXPECT_EQ(found[n].rotation, wanted[n].rotation) << n;
    EXPECT_EQ(found[n].height, wanted[n].height) << n;
    EXPECT_EQ(found[n].likelihood, wanted[n].likelihood) << n;
  }
}

TEST(StablePoses, AreTheSameBytesForAnyOrderAndOnAnyThread) {
  std::mt19937 random(kSeed);
  const auto points = test::randomPoints(random, 2, 300);
  const std::vector<Vec3> reversed(points.rbegin(), points.rend());
  const auto first = findStablePoses(test::meshOf(points));
  std::vector<std::vector<StablePose>> others(4);
  std::vector<std::thread> threads;
  for (std::size_t at = 0; at < others.size(); ++at) {
    threads.emplace_back(
        [&, at] { others[at] = findStablePoses(test::meshOf(at % 2 == 0 ? points : reversed)); });
  }
  for (std::thread& thread : threads) thread.join();
  static_assert(sizeof(StablePose) == 6 * sizeof(float));
  for (const auto& other : others) {
    ASSERT_EQ(other.size(), first.size());
    EXPECT_EQ(std::memcmp(other.data(), first.data(), first.size() * sizeof(StablePose)), 0);
  }
}

}  // namespace
}  // namespace galactic::bake::stable_poses_test
