// Real robots, where they are at hand: counts, warnings, and visual meshes that lie on their
// collision meshes.
#include <gmock/gmock.h>

#include <algorithm>
#include <cstdio>
#include <ostream>

#include "bake/robot_description/link_points.h"
#include "bake/robot_description/robot_texts.h"
#include "support/asset_mesh.h"

namespace galactic::test::real_robots_test {
namespace {

constexpr const char* kFetch = "robots/fetch/fetch_description/robots/fetch.urdf";
constexpr const char* kGalacticFetch = "robots/galactic_URDF/opt_fetch/robots/fetch.urdf";
constexpr const char* kSpot = "robots/galactic_URDF/spot_arm/urdf/spot_arm.urdf";
constexpr const char* kStretch =
    "robots/stretch/SE3/stretch_description_SE3_eoa_wrist_dw3_tool_sg3.urdf";

struct RealRobot {
  const char* path;
  std::size_t links;
  std::size_t visuals;
  std::size_t collisions;
  std::size_t meshes;
  std::size_t warnings;
  bool allow_missing = false;
};

std::ostream& operator<<(std::ostream& out, const RealRobot& robot) { return out << robot.path; }

/// Counts that lxml gives, less the files that are known to be missing.
std::vector<RealRobot> realRobots() {
  return {
      {"replica_cad/urdf/cabinet/cabinet.urdf", 4, 3, 7, 2, 1},
      {"replica_cad/urdf/cabinet/cabinet_dynamic.urdf", 4, 3, 7, 2, 1},
      {"replica_cad/urdf/doors/door2.urdf", 2, 1, 1, 1, 1},
      {"replica_cad/urdf/fridge/fridge.urdf", 4, 3, 12, 3, 0},
      {"replica_cad/urdf/fridge/fridge_dynamic.urdf", 4, 3, 12, 3, 0},
      {"replica_cad/urdf/kitchen_counter/kitchen_counter.urdf", 9, 8, 47, 5, 2},
      {"replica_cad/urdf/kitchen_cupboards/kitchenCupboard_01.urdf", 10, 9, 26, 5, 1},
      {kFetch, 26, 20, 21, 36, 1},
      {kGalacticFetch, 26, 2, 14, 12, 26, true},
      {kSpot, 21, 21, 21, 21, 2},
      {"robots/kuka_iiwa/model_free_base.urdf", 8, 8, 8, 8, 0},
      {kStretch, 61, 36, 37, 60, 1},
  };
}

Result<bake::SourceRobot> load(const RealRobot& robot) {
  bake::RobotImportOptions options;
  options.allow_missing = robot.allow_missing;
  return bake::importRobot(assetsFolder() / robot.path, options);
}

class RealRobots : public testing::TestWithParam<RealRobot> {
 protected:
  void SetUp() override {
    if (!hasAsset(GetParam().path)) GTEST_SKIP() << "no asset " << GetParam().path;
  }
};

TEST_P(RealRobots, LoadWithTheExpectedCounts) {
  const auto robot = load(GetParam());
  ASSERT_TRUE(robot.has_value()) << robot.error().text();
  std::size_t visuals = 0;
  std::size_t collisions = 0;
  for (const bake::SourceLink& link : robot->links) {
    visuals += link.visuals.size();
    collisions += link.collisions.size();
  }
  EXPECT_EQ(robot->links.size(), GetParam().links);
  EXPECT_EQ(visuals, GetParam().visuals);
  EXPECT_EQ(collisions, GetParam().collisions);
  EXPECT_EQ(robot->meshes.size(), GetParam().meshes);
  EXPECT_EQ(robot->warnings.size(), GetParam().warnings);
  for (const std::string& warning : robot->warnings) std::printf("%s\n", warning.c_str());
  for (const bake::SourceFile& file : robot->read.files) {
    EXPECT_FALSE(std::filesystem::path(file.name).is_absolute());
  }
}

INSTANTIATE_TEST_SUITE_P(Assets, RealRobots, testing::ValuesIn(realRobots()));

TEST(TheGalacticFetch, IsRefusedWithoutItsMeshes) {
  if (!hasAsset(kGalacticFetch)) GTEST_SKIP() << "no asset " << kGalacticFetch;
  const auto robot = bake::importRobot(assetsFolder() / kGalacticFetch);
  ASSERT_FALSE(robot.has_value());
  EXPECT_THAT(robot.error().where, testing::EndsWith("fetch.urdf: link 'torso_lift_link'"));
  EXPECT_THAT(robot.error().message, testing::StartsWith("it lost all its visual geometry"));
}

/// Visual meshes are detailed, collision meshes are their hulls; screws and logos stick out.
constexpr double kSameSurface = 0.012;

double farthestSide(const bake::Bounds& a, const bake::Bounds& b) {
  const auto difference = [](float p, float q) { return static_cast<double>(std::abs(p - q)); };
  return std::max({difference(a.min.x, b.min.x), difference(a.min.y, b.min.y),
                   difference(a.min.z, b.min.z), difference(a.max.x, b.max.x),
                   difference(a.max.y, b.max.y), difference(a.max.z, b.max.z)});
}

/// COLLADA files that state Z_UP, and STL files, which state nothing: both must agree.
TEST(FetchMeshes, OfColladaLieOnThoseOfStl) {
  if (!hasAsset(kFetch)) GTEST_SKIP() << "no asset " << kFetch;
  const auto robot = bake::importRobot(assetsFolder() / kFetch);
  ASSERT_TRUE(robot.has_value());
  std::size_t compared = 0;
  for (const bake::SourceLink& link : robot->links) {
    if (link.visuals.empty() || link.collisions.empty()) continue;
    const auto* visual = std::get_if<bake::MeshShape>(&link.visuals[0].geometry);
    const auto* collision = std::get_if<bake::MeshShape>(&link.collisions[0].geometry);
    ASSERT_TRUE(visual != nullptr && collision != nullptr);
    const bool collada = robot->meshes[visual->mesh].format == "COLLADA";
    if (!collada) continue;
    ++compared;
    const bake::Bounds a = meshInLink(*robot, link.visuals[0]).bounds;
    const bake::Bounds b = meshInLink(*robot, link.collisions[0]).bounds;
    EXPECT_LT(farthestSide(a, b), kSameSurface) << link.name;
  }
  EXPECT_GE(compared, 10U);
}

TEST(FetchInItsZeroPose, StandsUprightAndLooksForward) {
  if (!hasAsset(kFetch)) GTEST_SKIP() << "no asset " << kFetch;
  const auto robot = bake::importRobot(assetsFolder() / kFetch);
  ASSERT_TRUE(robot.has_value());
  std::vector<bake::Affine> root_from_link;
  for (const bake::SourceLink& link : robot->links) {
    root_from_link.push_back(link.parent < 0
                                 ? link.parent_from_joint
                                 : product(root_from_link[static_cast<std::size_t>(link.parent)],
                                           link.parent_from_joint));
  }
  const auto origin = [&](std::string_view name) {
    const auto& link = linkOf(*robot, name);
    return pointIn(root_from_link[static_cast<std::size_t>(&link - robot->links.data())],
                   {0, 0, 0});
  };
  // Published: the chain of offsets from the base to the hand, all forward and up.
  const Point3 hand = origin("gripper_link");
  EXPECT_NEAR(hand[0],
              -0.086875 + 0.119525 + 0.117 + 0.219 + 0.133 + 0.197 + 0.1245 + 0.1385 + 0.16645,
              1e-9);
  EXPECT_NEAR(hand[1], 0.37743 + 0.34858 + 0.06, 1e-4);
  EXPECT_NEAR(hand[2], 0, 1e-4);
  // The right wheel is at the right, +Z.
  EXPECT_NEAR(origin("r_wheel_link")[2], 0.18738, 1e-6);
}

}  // namespace
}  // namespace galactic::test::real_robots_test
