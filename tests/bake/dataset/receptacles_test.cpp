// Receptacles that a dataset annotates, in the world.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "bake/dataset/small_dataset.h"
#include "dataset/scene_dataset.h"
#include "support/assets.h"
#include "support/oracles/box_oracle.h"

namespace galactic::test::receptacles_test {
namespace {

using bake::ComposedScene;
using bake::MeshLibrary;
using bake::SceneDataset;
using bake::SupportRegion;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

using Point = std::array<double, 3>;
using Points = std::vector<Point>;

/// Regions hold floats; places are a few meters from the origin.
constexpr double kTolerance = 1e-5;

ComposedScene composed(const SmallDataset& small, const std::string& name = "a_home") {
  const auto dataset = SceneDataset::read(small.config());
  EXPECT_TRUE(dataset) << dataset.error().text();
  MeshLibrary meshes(bake::datasetMeshOptions());
  auto scene = dataset->compose(name, meshes);
  EXPECT_TRUE(scene) << scene.error().text();
  return scene ? std::move(*scene) : ComposedScene{};
}

std::string sceneOf(const std::string& more, const std::string& user = "{}") {
  return fmt::format(R"({{"stage_instance": {{"template_name": "room"}}, "user_defined": {},
                          {}}})",
                     user, more);
}

/// The corners of a box around `center`, in its own frame.
Points cornersAround(const Point& center, const Point& halves) {
  Points corners;
  for (unsigned corner = 0; corner < 8; ++corner) {
    Point& p = corners.emplace_back(center);
    for (unsigned axis = 0; axis < 3; ++axis) {
      p[axis] += (corner >> axis & 1U) != 0 ? halves[axis] : -halves[axis];
    }
  }
  return corners;
}

Points cornersOf(const SupportRegion& region) {
  const Vec3& half = region.half_extents;
  Points corners;
  for (const Point& p : cornersAround({}, {static_cast<double>(half.x), static_cast<double>(half.y),
                                           static_cast<double>(half.z)})) {
    const Vec3 world =
        region.world_from_region *
        Vec3{static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])};
    corners.push_back(
        {static_cast<double>(world.x), static_cast<double>(world.y), static_cast<double>(world.z)});
  }
  return corners;
}

template <class Change>
Points changed(Points points, const Change& change) {
  for (Point& p : points) p = change(p);
  return points;
}

/// v + 2 w (u x v) + 2 u x (u x v) for the quaternion (w, u).
Point turned(const std::array<double, 4>& q, const Point& v) {
  const auto cross = [&q](const Point& a) {
    return Point{q[2] * a[2] - q[3] * a[1], q[3] * a[0] - q[1] * a[2], q[1] * a[1] - q[2] * a[0]};
  };
  const Point once = cross(v);
  const Point twice = cross(once);
  Point result{};
  for (std::size_t n = 0; n < 3; ++n) result[n] = v[n] + 2 * q[0] * once[n] + 2 * twice[n];
  return result;
}

std::vector<std::string> namesOf(const std::vector<SupportRegion>& regions) {
  std::vector<std::string> names;
  for (const SupportRegion& region : regions) names.push_back(region.name);
  return names;
}

TEST(Receptacles, FollowTheirObjectThroughFrameScaleCenterAndPose) {
  const SmallDataset small;
  // Z up, front along +Y: (x, y, z) of the mesh becomes (x, z, -y), then comes the scale.
  small.write("configs/objects/big/shelf.object_config.json",
              R"({"render_asset": "../../../meshes/box.obj", "scale": [0.5, 2, 1.5],
                  "up": [0, 0, 1], "front": [0, 1, 0], "COM": [0.25, 0.5, 2], "user_defined": {
                    "receptacle_aabb_top": {"name": "top", "position": [1, 0.5, 4],
                      "scale": [0.5, -0.25, 0.125], "up": [0, 0, 1]}}})");
  std::mt19937 random(7);
  const auto number = [&random](double from, double to) {
    return from + (to - from) * uniform(random);
  };
  constexpr int kCases = 300;
  std::string items;
  std::map<std::string, Points> wanted;
  for (int n = 0; n < kCases; ++n) {
    // The axis is nearly upright half of the time.
    const double lean = n % 2 == 0 ? 0.2 : 1;
    std::array<double, 4> q{number(-1, 1), lean * number(-1, 1), number(-1, 1),
                            lean * number(-1, 1)};
    const double length = std::hypot(std::hypot(q[0], q[1]), std::hypot(q[2], q[3]));
    for (double& v : q) v /= length;
    const Point t{number(-3, 3), number(-3, 3), number(-3, 3)};
    const Point s{number(0.2, 2), number(0.2, 2), number(0.2, 2)};
    items += fmt::format(
        R"({}{{"template_name": "shelf", "motion_type": "STATIC", "translation": [{}],
            "rotation": [{}], "non_uniform_scale": [{}], "translation_origin": "COM"}})",
        n == 0 ? "" : ",", fmt::join(t, ","), fmt::join(q, ","), fmt::join(s, ","));
    if (turned(q, {0, 1, 0})[1] < 0.9) continue;
    const Point scale{0.5 * s[0], 2 * s[1], 1.5 * s[2]};
    wanted[fmt::format(
        "shelf_:{:04d}|top",
        n)] = changed(cornersAround({1, 0.5, 4}, {0.5, 0.25, 0.125}), [&](const Point& p) {
      const Point object{scale[0] * (p[0] - 0.25), scale[1] * (p[2] - 0.5), scale[2] * (-p[1] - 2)};
      const Point way = turned(q, object);
      return Point{t[0] + way[0], t[1] + way[1], t[2] + way[2]};
    });
  }
  small.writeScene("many", sceneOf(fmt::format(R"("object_instances": [{}])", items)));
  const ComposedScene scene = composed(small, "many");
  EXPECT_GT(wanted.size(), kCases / 10U);
  EXPECT_LT(wanted.size(), kCases * 9U / 10U);
  ASSERT_EQ(scene.receptacles.size(), wanted.size());
  for (const SupportRegion& region : scene.receptacles) {
    ASSERT_EQ(wanted.count(region.name), 1U) << region.name;
    EXPECT_LT(farthestCorner(cornersOf(region), wanted[region.name]), kTolerance) << region.name;
  }
}

TEST(Receptacles, FollowTheLinksOfFurnitureInItsRestPose) {
  const SmallDataset small;
  // The door hangs 1 m along x and stands at the nearest end of its limits, 0.5 rad about z, which
  // the scene turns upwards.
  small.write("urdf/cupboard/cupboard.ao_config.json", R"({"uniform_scale": 2, "user_defined": {
      "receptacle_aabb_board": {"parent_link": "base", "position": [0, 1, 0.5],
                                "scale": [0.5, 0.125, 1], "up": [0, 0, 1]},
      "receptacle_aabb_back": {"parent_link": "base", "position": [0, 1, 0.5],
                               "scale": [0.5, 0.125, 1], "up": [0, 0, -1]},
      "receptacle_aabb_bin": {"name": "bin", "parent_object": "cupboard", "parent_link": "door",
                              "position": [0.5, 0, 0.25], "scale": [0.1, 0.2, 0.3],
                              "up": [0, 0, 2]}}})");
  small.writeScene("one", sceneOf(R"("articulated_object_instances": [
      {"template_name": "cupboard", "translation": [0, 1, 3], "uniform_scale": 0.25,
       "rotation": [0.7071067811865476, -0.7071067811865476, 0, 0]}])"));
  const ComposedScene scene = composed(small, "one");
  ASSERT_THAT(namesOf(scene.receptacles),
              ElementsAre("cupboard_:0000|bin", "cupboard_:0000|receptacle_aabb_board"));
  // A quarter turn about x takes (x, y, z) to (x, z, -y); the scale is 2 * 0.25.
  const auto placed = [](const Point& p) {
    return Point{0.5 * p[0], 1 + 0.5 * p[2], 3 - 0.5 * p[1]};
  };
  const auto in_door = [&](const Point& p) {
    const double c = std::cos(0.5);
    const double s = std::sin(0.5);
    return placed({1 + c * p[0] - s * p[1], s * p[0] + c * p[1], p[2]});
  };
  EXPECT_LT(farthestCorner(cornersOf(scene.receptacles[0]),
                           changed(cornersAround({0.5, 0, 0.25}, {0.1, 0.2, 0.3}), in_door)),
            kTolerance);
  EXPECT_LT(farthestCorner(cornersOf(scene.receptacles[1]),
                           changed(cornersAround({0, 1, 0.5}, {0.5, 0.125, 1}), placed)),
            kTolerance);
}

TEST(Receptacles, OfStageAndSceneStandInTheWorldAndMayBeTurned) {
  const SmallDataset small;
  small.write("configs/stages/room.stage_config.json",
              R"({"render_asset": "../../meshes/room.obj", "up": [0, 0, 1], "front": [0, 1, 0],
                  "scale": [2, 2, 2], "user_defined": {"receptacle_aabb_sill": {
                    "position": [1, 2, 3], "scale": [0.5, 0.25, 0],
                    "rotation": [0.9689124217106447, 0, 0, 0.24740395925452294]}}})");
  small.writeScene("one", sceneOf(R"("object_instances": [])", R"({"receptacle_aabb_rug":
      {"name": "rug", "position": [1, 0, 2], "scale": [1, 0.125, 0.5]}, "mood": 3})"));
  const ComposedScene scene = composed(small, "one");
  ASSERT_THAT(namesOf(scene.receptacles), ElementsAre("receptacle_aabb_sill", "rug"));
  // Half a radian about the box's z, which is the stage's up. As in Habitat the scale is not for
  // it.
  const auto on_stage = [](const Point& p) {
    const Point in_asset{1 + std::cos(0.5) * p[0] - std::sin(0.5) * p[1],
                         2 + std::sin(0.5) * p[0] + std::cos(0.5) * p[1], 3 + p[2]};
    return Point{in_asset[0], in_asset[2], -in_asset[1]};
  };
  EXPECT_LT(farthestCorner(cornersOf(scene.receptacles[0]),
                           changed(cornersAround({}, {0.5, 0.25, 0}), on_stage)),
            kTolerance);
  EXPECT_LT(
      farthestCorner(cornersOf(scene.receptacles[1]), cornersAround({1, 0, 2}, {1, 0.125, 0.5})),
      kTolerance);
}

TEST(Receptacles, OfAnInstanceAreStatedOverThoseOfItsTemplate) {
  const SmallDataset small;
  small.write("configs/objects/big/table.object_config.json",
              R"({"render_asset": "../../../meshes/box.obj", "COM": [0, 0, 0], "user_defined": {
                    "receptacle_aabb_a": {"name": "a", "position": [0, 1, 0], "scale": [1, 1, 1]},
                    "receptacle_aabb_b": {"name": "b", "position": [0, 2, 0], "scale": [1, 1, 1]}}})");
  small.writeScene("one", sceneOf(R"("object_instances": [
      {"template_name": "table", "motion_type": "STATIC"},
      {"template_name": "table", "motion_type": "KINEMATIC", "user_defined": {
         "receptacle_aabb_b": {"position": [0, 3, 0]},
         "receptacle_aabb_c": {"position": [0, 4, 0], "scale": [1, 1, 1]}}},
      {"template_name": "table", "motion_type": "DYNAMIC"}])"));
  const ComposedScene scene = composed(small, "one");
  EXPECT_THAT(namesOf(scene.receptacles),
              ElementsAre("table_:0000|a", "table_:0000|b", "table_:0001|a", "table_:0001|b",
                          "table_:0001|receptacle_aabb_c"));
  EXPECT_EQ(scene.receptacles[1].world_from_region.translation.y, 2.F);
  EXPECT_EQ(scene.receptacles[3].world_from_region.translation.y, 3.F);
}

struct Fault {
  std::string key;
  std::string stated;
  std::string warning;
  /// Whether the box is used nevertheless.
  bool is_used = false;
};

std::vector<Fault> faultsOfAll() {
  const std::string key = "receptacle_aabb_x";
  return {
      {key, "7", "user_defined.receptacle_aabb_x: expected an object"},
      {key, R"({"scale": [1, 1, 1]})", "receptacle_aabb_x.position: it is missing"},
      {key, R"({"position": [1, 1, 1]})", "receptacle_aabb_x.scale: it is missing"},
      {key, R"({"position": [1, 1], "scale": [1, 1, 1]})",
       ".position: it has 2 numbers, expected 3"},
      {key, R"({"position": [1, 1, 1], "scale": [1, "a", 1]})", ".scale[1]: "},
      {key, R"({"position": [1, 1e9, 1], "scale": [1, 1, 1]})", ".position[1]: "},
      {key, R"({"position": [1, 1, 1], "scale": [1, 0, 0]})", ".scale: it has several half ext"},
      {key, R"({"position": [1, 1, 1], "scale": [1, 1, 1], "up": [0, 1, 1]})",
       ".up: it is [0, 1, 1]; expected one of the box's axes"},
      {key, R"({"position": [1, 1, 1], "scale": [1, 1, 1], "rotation": [0, 0, 0, 0]})",
       ".rotation: it is a quaternion (w, x, y, z) of length 0"},
      {key, R"({"position": [1, 1, 1], "scale": [1, 1, 1], "rotation": [1, 0, 1, 0]})",
       ".rotation: only boxes of stages and scenes are turned", true},
      {key, R"({"position": [1, 1, 1], "scale": [1, 1, 1], "name": 3})", ".name: "},
  };
}

/// What only an object, or only furniture, can have wrong.
std::vector<Fault> faultsOfObjects() {
  std::vector<Fault> faults = faultsOfAll();
  faults.push_back({"receptacle_aabb_x",
                    R"({"position": [1, 1, 1], "scale": [1, 1, 1], "parent_link": "door"})",
                    ".parent_link: it is 'door', but nothing here has links"});
  faults.push_back({"receptacle_mesh_x", R"({"mesh_filepath": "x.ply"})",
                    "receptacle_mesh_x: receptacles made of meshes are not supported"});
  faults.push_back({"receptacle_x", R"({"position": [1, 1, 1], "scale": [1, 1, 1]})",
                    "receptacle_x: it is neither receptacle_aabb_* nor receptacle_mesh_*"});
  return faults;
}

std::vector<Fault> faultsOfFurniture() {
  return {
      {"receptacle_aabb_x", R"({"position": [1, 1, 1], "scale": [1, 1, 1]})",
       ".parent_link: it is '', expected one of the URDF's links: root, base, door"},
      {"receptacle_aabb_x", R"({"position": [1, 1, 1], "scale": [1, 1, 1], "parent_link": "body"})",
       ".parent_link: it is 'body', expected one of the URDF's links: root, base, door"}};
}

/// Of all warnings, those about receptacles.
std::vector<std::string> warningsOf(const ComposedScene& scene) {
  std::vector<std::string> warnings;
  for (const std::string& warning : scene.scene.warnings) {
    if (warning.find("receptacle_") != std::string::npos) warnings.push_back(warning);
  }
  return warnings;
}

TEST(Receptacles, ThatAreMalformedAreLeftOutWithAWarningThatNamesFileAndKey) {
  const std::string good = R"("receptacle_aabb_good": {"parent_link": "base",
                               "position": [0, 0, 0], "scale": [1, 1, 1]})";
  const std::string good_object = R"("receptacle_aabb_good": {"position": [0, 0, 0],
                                     "scale": [1, 1, 1]})";
  const SmallDataset small;
  small.writeScene("object", sceneOf(R"("object_instances": [
      {"template_name": "table", "motion_type": "STATIC"},
      {"template_name": "table", "motion_type": "STATIC"}])"));
  small.writeScene("furniture", sceneOf(R"("articulated_object_instances": [
      {"template_name": "cupboard"}])"));
  for (const Fault& fault : faultsOfObjects()) {
    small.write("configs/objects/big/table.object_config.json",
                fmt::format(R"({{"render_asset": "../../../meshes/box.obj",
                                 "user_defined": {{"{}": {}, {}}}}})",
                            fault.key, fault.stated, good_object));
    const ComposedScene scene = composed(small, "object");
    EXPECT_EQ(scene.receptacles.size(), fault.is_used ? 4U : 2U) << fault.stated;
    // Once, however often the table stands there.
    EXPECT_THAT(warningsOf(scene),
                ElementsAre(testing::AllOf(
                    testing::StartsWith(
                        "configs/objects/big/table.object_config.json: user_defined.receptacle_"),
                    HasSubstr(fault.warning))))
        << fault.stated;
  }
  for (const Fault& fault : faultsOfFurniture()) {
    small.write(
        "urdf/cupboard/cupboard.ao_config.json",
        fmt::format(R"({{"user_defined": {{"{}": {}, {}}}}})", fault.key, fault.stated, good));
    const ComposedScene scene = composed(small, "furniture");
    EXPECT_EQ(scene.receptacles.size(), 1U) << fault.stated;
    EXPECT_THAT(
        warningsOf(scene),
        ElementsAre(testing::AllOf(testing::StartsWith("urdf/cupboard/cupboard.ao_config.json: "),
                                   HasSubstr(fault.warning))))
        << fault.stated;
  }
}

TEST(Receptacles, ThatAnUnevenScaleLeavesObliqueAreLeftOut) {
  const SmallDataset small;
  // The frame is turned by 45 degrees about x before the scale applies.
  small.write("configs/objects/big/table.object_config.json",
              R"({"render_asset": "../../../meshes/box.obj", "up": [0, 1, 1],
                  "front": [0, 1, -1], "user_defined": {"receptacle_aabb_a":
                    {"position": [0, 0, 0], "scale": [1, 1, 1], "up": [0, 1, 0]}}})");
  const std::string table = R"({"template_name": "table", "motion_type": "STATIC",
      "rotation": [0.9238795325112867, 0.3826834323650898, 0, 0], "non_uniform_scale": [1, )";
  small.writeScene("even", sceneOf(R"("object_instances": [)" + table + "1, 1]}]"));
  small.writeScene("oblique", sceneOf(R"("object_instances": [)" + table + "1.5, 1]}]"));
  EXPECT_EQ(composed(small, "even").receptacles.size(), 1U);
  const ComposedScene oblique = composed(small, "oblique");
  EXPECT_THAT(oblique.receptacles, IsEmpty());
  EXPECT_THAT(warningsOf(oblique), ElementsAre(HasSubstr("leave the box oblique")));
}

}  // namespace
}  // namespace galactic::test::receptacles_test
