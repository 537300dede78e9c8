// Whether robots touch themselves, against all pairs of their spheres in double precision.
#include "galactic/self_collision.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "galactic/error.h"
#include "galactic/kinematics.h"
#include "support/aligned_bytes.h"
#include "support/packs/robot_pack_builder.h"

namespace galactic::test::self_collision_test {
namespace {

constexpr unsigned kSeed = 20230614;
/// Nearer to the border than floats tell, meters.
constexpr double kUnsure = 1e-5;
/// Both answers come up at least this often.
constexpr double kLeastShare = 0.1;

/// A chain of links of 30 cm on joints about +Z, each with two spheres.
RobotPackFields chain(std::size_t links) {
  RobotPackFields robot = smallRobotPack();
  robot.links.clear();
  robot.link_names.clear();
  robot.joint_names.clear();
  robot.spheres.clear();
  robot.groups.clear();
  robot.group_pairs.clear();
  for (std::uint32_t n = 0; n < links; ++n) {
    LinkFrame frame;
    frame.parent_from_joint = {{n == 0 ? 0.0F : 0.3F, 0, 0}, {}};
    frame.axis = {0, 0, 1};
    frame.parent = static_cast<std::int32_t>(n) - 1;
    frame.type = n == 0 ? JointType::kFixed : JointType::kRevolute;
    frame.position = static_cast<std::int32_t>(n) - 1;
    robot.links.push_back(frame);
    robot.link_names.push_back("link" + std::to_string(n));
    robot.joint_names.push_back(n == 0 ? "" : "joint" + std::to_string(n));
    robot.spheres.push_back({{0.1F, 0, 0}, 1});
    robot.spheres.push_back({{0.25F, 0, 0}, 0});
    robot.groups.push_back({n, {n}, 2 * n, 2, SphereStatisticsFields{}});
    for (std::uint32_t below = 0; below < n; ++below) {
      const bool is_adjacent = below + 1 == n;
      robot.group_pairs.push_back({static_cast<std::uint16_t>(below), static_cast<std::uint16_t>(n),
                                   static_cast<std::uint8_t>(is_adjacent ? 1 : 0)});
    }
  }
  std::ranges::sort(robot.group_pairs, {},
                    [](const PairFields& pair) { return std::pair(pair.first, pair.second); });
  robot.limits.assign(links - 1, {-3, 3});
  robot.start_positions.assign(links - 1, 0);
  robot.controlled_joints = {{0, 0.1F, -3, 3}};
  robot.surfaces.clear();
  robot.end_effector.reset();
  robot.camera.reset();
  robot.base.reset();
  robot.laser.reset();
  return robot;
}

class MadeRobot {
 public:
  explicit MadeRobot(const RobotPackFields& fields)
      : bytes_(buildPack(fields)),
        pack_(orThrow(PackFile::view(bytes_.bytes(), "robot"))),
        robot_(orThrow(Robot::from(pack_))) {}

  [[nodiscard]] const Robot& operator*() const { return robot_; }
  [[nodiscard]] std::vector<Pose> linksAt(std::span<const float> positions,
                                          const Pose& world_from_root = {}) const {
    std::vector<Pose> links(robot_.links().size());
    forwardKinematics(robot_.links(), world_from_root, positions, links);
    return links;
  }

 private:
  AlignedBytes bytes_;
  PackFile pack_;
  Robot robot_;
};

/// The least distance between spheres of two groups, meters; below 0 where they overlap.
double gapOf(const Robot& robot, const GroupPair& pair, std::span<const Pose> links) {
  double least = HUGE_VAL;
  const SphereGroup& first = robot.groups()[pair.first];
  const SphereGroup& second = robot.groups()[pair.second];
  for (const SetSphere& a : first.spheres) {
    for (const SetSphere& b : second.spheres) {
      const Vec3 away = links[first.link] * a.center - links[second.link] * b.center;
      const double distance = std::hypot(static_cast<double>(away.x), static_cast<double>(away.y),
                                         static_cast<double>(away.z));
      const auto radii = static_cast<double>(robot.radii()[a.radius_index]) +
                         static_cast<double>(robot.radii()[b.radius_index]);
      least = std::min(least, distance - radii);
    }
  }
  return least;
}

TEST(SelfCollision, AgreesWithAllPairsOfSpheresWithAndWithoutMargin) {
  const MadeRobot robot(chain(5));
  const SelfCollision self_collision(*robot);
  ASSERT_EQ(self_collision.pairs().size(), 6U);
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<float> number(-3, 3);
  const Pose somewhere{{1, 2, -3}, rotationOfYaw(0.7F)};
  for (const float margin : {0.0F, 0.05F, -0.02F}) {
    constexpr int kPoses = 2000;
    int touches = 0;
    for (int n = 0; n < kPoses; ++n) {
      std::vector<float> positions(4);
      for (float& position : positions) position = number(random);
      const std::vector<Pose> links = robot.linksAt(positions, somewhere);
      double least = HUGE_VAL;
      for (const GroupPair& pair : self_collision.pairs()) {
        least = std::min(least, gapOf(*robot, pair, links));
      }
      const bool touching = self_collision.touches(links, margin);
      touches += touching ? 1 : 0;
      const double beyond = least - static_cast<double>(margin);
      if (std::fabs(beyond) < kUnsure) continue;
      EXPECT_EQ(touching, beyond < 0) << "seed " << kSeed;
    }
    EXPECT_GE(touches, kLeastShare * kPoses) << margin;
    EXPECT_LE(touches, (1 - kLeastShare) * kPoses) << margin;
  }
}

TEST(SelfCollision, LeavesOutPairsThatTouchAtTheStart) {
  RobotPackFields fields = chain(3);
  const MadeRobot apart(fields);
  const SelfCollision tests_them(*apart);
  ASSERT_EQ(tests_them.pairs().size(), 1U);
  EXPECT_EQ(tests_them.pairs()[0].first, 0);
  EXPECT_EQ(tests_them.pairs()[0].second, 2);
  const std::vector<float> folded{2.9F, 2.9F};
  EXPECT_TRUE(tests_them.touches(apart.linksAt(folded)));
  EXPECT_FALSE(tests_them.touches(apart.linksAt(fields.start_positions)));

  fields.start_positions = folded;
  const MadeRobot touching(fields);
  const SelfCollision leaves_them(*touching);
  EXPECT_TRUE(leaves_them.pairs().empty());
  EXPECT_FALSE(leaves_them.touches(touching.linksAt(folded)));
}

TEST(SelfCollision, DoesNotLookAtPairsThatTheBakeHasNotLeftToTest) {
  RobotPackFields fields = chain(3);
  for (PairFields& pair : fields.group_pairs)
    pair.kind = static_cast<std::uint8_t>(PairKind::kNever);
  const MadeRobot robot(fields);
  const SelfCollision self_collision(*robot);
  EXPECT_TRUE(self_collision.pairs().empty());
  EXPECT_FALSE(self_collision.touches(robot.linksAt(std::vector{2.9F, 2.9F})));
}

}  // namespace
}  // namespace galactic::test::self_collision_test
