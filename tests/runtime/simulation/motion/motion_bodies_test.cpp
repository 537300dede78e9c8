// Where the motion kernels put spheres, grip and bodies, against the forward kinematics of single
// robots; and the builds of the kernels against each other.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <optional>
#include <random>
#include <span>
#include <string>

#include "motion_batch.h"
#include "support/build_paths.h"
#include "support/file_content.h"
#include "support/homes/box_world.h"
#include "support/homes/random_robot.h"
#include "support/processor.h"
#include "support/sanitized.h"

namespace galactic::test::motion_bodies_test {
namespace {

using namespace galactic::simulation;

/// Both sides are floats along chains of up to twenty links, some meters from the origin; most are
/// off by less than half of it.
constexpr float kLengthTolerance = 2e-5F;
/// Of the elements of rotation matrices: at each joint angles of up to 7 radians are rounded.
constexpr float kAxisTolerance = 3e-5F;

AlignedBytes readFile(const std::filesystem::path& path) {
  const std::string content = fileContent(path);
  return AlignedBytes(std::as_bytes(std::span(content)));
}

MotionRobot goldenArm() {
  const auto path = test::sourceFolder() / "packs/golden/arm.pack";
  return {readFile(path), {}};
}

MotionRobot randomRobot(std::mt19937& random) {
  // Position 1 is moved by no action; every other robot's episodes set it.
  const std::vector<std::uint32_t> also_variable(random() % 2, 1);
  return {buildPack(RandomRobotMaker(random).robot()), also_variable};
}

float largestDifference(const Vec3& a, const Vec3& b) {
  return std::max({std::abs(a.x - b.x), std::abs(a.y - b.y), std::abs(a.z - b.z)});
}

/// The farthest that the kernels are off the forward kinematics of single robots.
struct Differences {
  float length = 0;
  float axis = 0;

  void addAxes(const Vec3& x, const Vec3& y, const Vec3& z, const Quat& wanted) {
    axis = std::max({axis, largestDifference(x, rotate(wanted, {1, 0, 0})),
                     largestDifference(y, rotate(wanted, {0, 1, 0})),
                     largestDifference(z, rotate(wanted, {0, 0, 1}))});
  }
  void addPoint(const Vec3& point, const Vec3& wanted) {
    length = std::max(length, largestDifference(point, wanted));
  }
};

/// One env of a batch, beside a single robot in the same pose.
class SingleRobot {
 public:
  SingleRobot(const MotionRobot& robot, MotionBatch& batch, std::size_t env)
      : robot_(robot), batch_(batch), env_(env), links_(robot.robot->links().size()) {
    const Robot& one = *robot.robot;
    std::vector<float> positions(one.startPositions().begin(), one.startPositions().end());
    for (std::size_t v = 0; v < robot.model.variables.size(); ++v) {
      positions[robot.model.variables[v].position] = batch.variable(v, env);
    }
    const double half = 0.5 * static_cast<double>(batch.yaw[env]);
    const Pose world_from_root{
        {batch.x[env], batch.y[env] + one.base()->root_height, batch.z[env]},
        {0, static_cast<float>(std::sin(half)), 0, static_cast<float>(std::cos(half))}};
    forwardKinematics(one.links(), world_from_root, positions, links_);
  }

  void compareSpheres(Differences& worst) const {
    const std::span<const std::uint32_t> order = robot_.model.spheres_by_link;
    std::size_t next = 0;
    for (const galactic::SphereGroup& group : robot_.robot->groups()) {
      for (const SetSphere& sphere : group.spheres) {
        ASSERT_LT(next, order.size());
        const std::uint32_t at = order[next++];
        ASSERT_EQ(radiusOf(at), sphere.radius_index);
        worst.addPoint(batch_.center(env_, at), links_[group.link] * sphere.center);
      }
    }
    ASSERT_EQ(next, order.size());
    for (const RadiusRange& range : robot_.model.ranges) {
      const std::uint32_t end = range.first + range.count;
      for (std::size_t n = end; n < range.first + paddedToLanes(range.count); ++n) {
        EXPECT_EQ(batch_.center(env_, n), batch_.center(env_, end - 1));
      }
    }
  }

  void compareGrip(Differences& worst) const {
    const auto grip = batch_.grip(env_);
    const EndEffector& tool = *robot_.robot->endEffector();
    worst.addAxes({grip[0], grip[1], grip[2]}, {grip[3], grip[4], grip[5]},
                  {grip[6], grip[7], grip[8]}, links_[tool.link].rotation);
    worst.addPoint({grip[9], grip[10], grip[11]}, links_[tool.link] * tool.grasp_point);
    const auto yaw = static_cast<double>(batch_.yaw[env_]);
    worst.axis = std::max({worst.axis, std::abs(grip[12] - static_cast<float>(std::cos(yaw))),
                           std::abs(grip[13] - static_cast<float>(std::sin(yaw)))});
  }

  void compareLinks(Differences& worst) const {
    for (std::size_t n = 0; n < links_.size(); ++n) {
      const FixedFrame& place = robot_.model.links[n];
      const RigidTransform& body = batch_.body(env_, static_cast<std::size_t>(place.node + 1));
      const auto turned = [&](const Vec3& v) {
        return body.x_axis * v.x + body.y_axis * v.y + body.z_axis * v.z;
      };
      worst.addAxes(turned(place.x_axis), turned(place.y_axis), turned(place.z_axis),
                    links_[n].rotation);
      worst.addPoint(turned(place.origin) + body.origin, links_[n].translation);
    }
  }

 private:
  [[nodiscard]] std::optional<std::uint32_t> radiusOf(std::uint32_t sphere) const {
    for (const RadiusRange& range : robot_.model.ranges) {
      if (sphere >= range.first && sphere < range.first + range.count) return range.radius_index;
    }
    return std::nullopt;
  }

  const MotionRobot& robot_;
  MotionBatch& batch_;
  std::size_t env_;
  std::vector<Pose> links_;
};

/// Random ones.
constexpr int kRobots = kIsSanitized ? 20 : 200;

void compareWithSingleRobots(const MotionRobot& robot, std::mt19937& random, Differences& worst) {
  MotionBatch batch(robot);
  for (int round = 0; round < 20; ++round) {
    batch.draw(random);
    batch.place(motionKernels());
    for (std::size_t env = 0; env < MotionBatch::kEnvs; ++env) {
      const SingleRobot single(robot, batch, env);
      single.compareSpheres(worst);
      single.compareGrip(worst);
      single.compareLinks(worst);
    }
  }
}

void expectSmall(const Differences& worst) {
  std::printf("worst: %.2g m, %.2g of an axis\n", static_cast<double>(worst.length),
              static_cast<double>(worst.axis));
  EXPECT_LT(worst.length, kLengthTolerance);
  EXPECT_LT(worst.axis, kAxisTolerance);
}

void compareKernels(const MotionRobot& robot, const MotionKernels& kernels, std::mt19937& random) {
  MotionBatch portable(robot);
  for (int round = 0; round < 20; ++round) {
    portable.draw(random);
    const std::size_t unwanted = random() % 3;
    for (std::size_t n = 0; n < unwanted; ++n) portable.wanted[random() % MotionBatch::kEnvs] = 0;
    MotionBatch fast = portable;
    // Eight envs have kernels of their own where sixteen do.
    const std::size_t envs = round % 2 == 0 ? MotionBatch::kEnvs : kLanes;
    portable.move(portableMotion(), envs);
    portable.place(portableMotion(), envs);
    fast.move(kernels, envs);
    fast.place(kernels, envs);
    ASSERT_EQ(portable.moved(), fast.moved());
    ASSERT_EQ(portable.placed(), fast.placed());
  }
}

/// On random robots and the golden arm.
void compareKernels(const MotionKernels& kernels, std::uint32_t seed) {
  std::printf("seed %u\n", seed);
  std::mt19937 random(seed);
  for (int n = 0; n < kRobots; ++n) compareKernels(randomRobot(random), kernels, random);
  compareKernels(goldenArm(), kernels, random);
}

TEST(MotionBodies, StandWhereThoseOfSingleRobotsStand) {
  constexpr std::uint32_t kSeed = 501;
  std::printf("seed %u\n", kSeed);
  std::mt19937 random(kSeed);
  Differences worst;
  Tally mimics;
  for (int n = 0; n < kRobots; ++n) {
    const MotionRobot robot = randomRobot(random);
    mimics.add(robot.model.nodes.size() > robot.model.variables.size());
    compareWithSingleRobots(robot, random, worst);
  }
  mimics.expectBothSides();
  expectSmall(worst);
}

TEST(MotionBodies, StandWhereThoseOfTheGoldenArmStand) {
  std::mt19937 random(502);
  Differences worst;
  compareWithSingleRobots(goldenArm(), random, worst);
  expectSmall(worst);
}

TEST(MotionKernels, AgreeBitForBitWithAndWithoutAvx2) {
  if (!detail::hasAvx2()) GTEST_SKIP() << "this processor has no AVX2";
  compareKernels(avx2Motion(), 503);
}

TEST(MotionKernels, AgreeBitForBitWithAndWithoutAvx512) {
  if (!detail::hasAvx512()) GTEST_SKIP() << "this processor has no AVX-512";
  compareKernels(avx512Motion(), 505);
}

/// Least and most of each coordinate of the spheres from `first` on.
std::array<float, kBounds> boundsOf(const MotionBatch& batch, std::size_t env, std::size_t first,
                                    std::size_t end) {
  const Vec3 at = batch.center(env, first);
  std::array<float, kBounds> bounds{at.x, at.x, at.y, at.y, at.z, at.z};
  for (std::size_t n = first; n < end; ++n) {
    const Vec3 center = batch.center(env, n);
    const std::array<float, 3> axes{center.x, center.y, center.z};
    for (std::size_t axis = 0; axis < axes.size(); ++axis) {
      bounds[2 * axis] = std::min(bounds[2 * axis], axes[axis]);
      bounds[2 * axis + 1] = std::max(bounds[2 * axis + 1], axes[axis]);
    }
  }
  return bounds;
}

TEST(MotionBodies, HaveTheBoundsOfTheirSpheresEightByEight) {
  constexpr std::uint32_t kSeed = 504;
  std::printf("seed %u\n", kSeed);
  std::mt19937 random(kSeed);
  for (int round = 0; round < 50; ++round) {
    const MotionRobot robot = randomRobot(random);
    const std::size_t spheres = robot.model.spheres.size();
    MotionBatch batch(robot);
    batch.draw(random);
    batch.place(motionKernels());
    for (std::size_t env = 0; env < MotionBatch::kEnvs; ++env) {
      const std::array<float, kBounds> all = boundsOf(batch, env, 0, spheres);
      for (std::size_t b = 0; b < kBounds; ++b) {
        ASSERT_EQ(batch.extent(env, b), all[b]);
        for (std::size_t group = 0; group < batch.groupStride(); ++group) {
          // Beyond the last group the first of its eight is repeated.
          const bool is_there = group < spheres / kLanes;
          const std::size_t from = (is_there ? group : group / kLanes * kLanes) * kLanes;
          ASSERT_EQ(batch.bound(env, b, group), boundsOf(batch, env, from, from + kLanes)[b]);
        }
      }
    }
  }
}

/// The sum of the edges of the bounds of eights of spheres, in the order of `spheres`.
float edgesOfEights(std::span<const BodySphere> spheres) {
  float sum = 0;
  for (std::size_t first = 0; first < spheres.size(); first += kLanes) {
    const auto eight = spheres.subspan(first, std::min(kLanes, spheres.size() - first));
    for (const auto coordinate : {&Vec3::x, &Vec3::y, &Vec3::z}) {
      const auto along = [&](const BodySphere& sphere) { return sphere.center.*coordinate; };
      const auto [least, most] = std::ranges::minmax_element(eight, {}, along);
      sum += along(*most) - along(*least);
    }
  }
  return sum;
}

TEST(MotionModel, PutsSpheresThatAreCloseTogetherIntoOneEight) {
  // Packs have spheres by their X first; these lie in clusters along Z.
  std::mt19937 random(507);
  RobotPackFields fields = smallRobotPack();
  constexpr std::uint32_t kClusters = 6;
  constexpr std::uint32_t kSpheres = 48;
  std::vector<SetSphere> clusters(kSpheres, SetSphere{{}, 1});
  for (std::uint32_t n = 0; n < kSpheres; ++n) {
    clusters[n].center = {0.5F + 0.001F * static_cast<float>(n), uniformIn(random, 0, 0.1F),
                          static_cast<float>(n % kClusters) + uniformIn(random, 0, 0.1F)};
  }
  // After the base's own sphere of that radius.
  fields.spheres.insert(fields.spheres.begin() + 1, clusters.begin(), clusters.end());
  fields.groups[0].sphere_count += kSpheres;
  for (std::size_t n = 1; n < fields.groups.size(); ++n) fields.groups[n].first_sphere += kSpheres;
  const MotionRobot robot(buildPack(fields), {});
  const auto& ranges = robot.model.ranges;
  const auto range = std::ranges::max_element(ranges, {}, &RadiusRange::count);
  ASSERT_GE(range->count, kSpheres);
  const auto spheres = std::span(robot.model.spheres).subspan(range->first, range->count);
  std::vector<BodySphere> as_given;
  for (const std::uint32_t n : robot.model.spheres_by_link) {
    if (n >= range->first && n < range->first + range->count) {
      as_given.push_back(robot.model.spheres[n]);
    }
  }
  EXPECT_LT(edgesOfEights(spheres), 0.5F * edgesOfEights(as_given));
  // All are there, each once.
  std::vector<std::uint32_t> order = robot.model.spheres_by_link;
  std::ranges::sort(order);
  EXPECT_EQ(std::ranges::adjacent_find(order), order.end());
}

TEST(MotionModel, HasOneVariableForEachJointThatMovesAndFoldsTheOthers) {
  RobotPackFields fields = smallRobotPack();
  fields.start_positions[1] = 0.5F;
  const MotionRobot robot(buildPack(fields), {2});
  // Elbow and lift by action, the wrist by episodes; tray and ball stay.
  ASSERT_EQ(robot.model.variables.size(), 3U);
  EXPECT_EQ(robot.model.variables[0].position, 1U);
  EXPECT_EQ(robot.model.variables[0].action, 0);
  EXPECT_EQ(robot.model.variables[1].position, 0U);
  EXPECT_EQ(robot.model.variables[2].position, 2U);
  EXPECT_EQ(robot.model.variables[2].action, -1);
  EXPECT_TRUE(robot.model.variables[2].wraps);
  // Torso, arm, hand and the finger that follows the arm.
  EXPECT_EQ(robot.model.nodes.size(), 4U);
  std::mt19937 random(504);
  Differences worst;
  compareWithSingleRobots(robot, random, worst);
  expectSmall(worst);
}

TEST(MotionModel, DoesNotWrapAnglesThatGearsFollow) {
  // A whole turn of the wrist is half a turn of a finger that follows it with half its speed.
  RobotPackFields fields = smallRobotPack();
  fields.links[4].position = 2;
  const auto wraps = [&](float multiplier) {
    fields.links[4].multiplier = multiplier;
    return MotionRobot(buildPack(fields), {2}).model.variables[2].wraps;
  };
  EXPECT_TRUE(wraps(-2));
  EXPECT_FALSE(wraps(0.5F));
  fields.links[4].type = JointType::kPrismatic;
  EXPECT_FALSE(wraps(1));
}

TEST(MotionModel, DoesNotWrapAnglesThatARecipeLimits) {
  const auto wraps = [&](float lower, float upper) {
    RobotPackFields fields = cartRobot();
    fields.controlled_joints[1].lower = lower;
    fields.controlled_joints[1].upper = upper;
    return MotionRobot(buildPack(fields), {}).model.variables[1].wraps;
  };
  constexpr float kMost = std::numeric_limits<float>::max();
  EXPECT_TRUE(wraps(-kMost, kMost));
  EXPECT_FALSE(wraps(-8, 8));
  EXPECT_FALSE(wraps(-1, kMost));
  EXPECT_FALSE(wraps(-3, 4));
  EXPECT_FALSE(wraps(0, 6.28F));
  EXPECT_FALSE(wraps(-2, 2));
}

TEST(MotionModel, RefusesActionsOnPlanarAndFloatingJoints) {
  for (const std::uint32_t position : {4U, 8U}) {
    const AlignedBytes bytes = buildPack(smallRobotPack());
    const auto pack = PackFile::view(bytes.bytes(), "robot");
    const auto robot = Robot::from(*pack);
    const auto model = makeMotionModel(*robot, std::vector{position});
    ASSERT_FALSE(model.has_value());
    EXPECT_EQ(model.error().code, ErrorCode::kUnsupported);
    EXPECT_EQ(model.error().where, position == 4 ? "joint slide" : "joint free");
  }
}

TEST(MotionModel, RefusesRobotsWithoutSpheresOrEndEffectorOrBase) {
  const auto refused = [](const RobotPackFields& fields) {
    const AlignedBytes bytes = buildPack(fields);
    const auto pack = PackFile::view(bytes.bytes(), "robot");
    const auto robot = Robot::from(*pack);
    const auto model = makeMotionModel(*robot, {});
    return model.has_value() ? std::string("accepted") : model.error().message;
  };
  RobotPackFields fields = smallRobotPack();
  fields.end_effector.reset();
  EXPECT_NE(refused(fields).find("end effector"), std::string::npos) << refused(fields);
  fields = smallRobotPack();
  fields.base.reset();
  EXPECT_NE(refused(fields).find("no base"), std::string::npos) << refused(fields);
  fields = smallRobotPack();
  fields.spheres.clear();
  for (GroupFields& group : fields.groups) group.first_sphere = group.sphere_count = 0;
  EXPECT_NE(refused(fields).find("no collision spheres"), std::string::npos) << refused(fields);
}

}  // namespace
}  // namespace galactic::test::motion_bodies_test
