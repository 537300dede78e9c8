// The published collections: what they become, and what can be wrong with them.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <ostream>

#include "bake/recipe/recipe_helpers.h"
#include "galactic/bake/robot_import.h"
#include "recipe/collection_import.h"
#include "support/asset_mesh.h"

namespace galactic::test::collection_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* kRobot = R"({"urdfFilepath": "small.urdf",
  "startJointPositions": [0, 0.5, 0, 0],
  "actionMap": {"numActions": 4,
    "baseMove": {"actionIdx": 1, "stepMin": -0.2, "stepMax": 0.2},
    "baseRotate": {"actionIdx": 2, "stepMin": -0.1, "stepMax": 0.1},
    "joints": [{"first": 1, "second": {"actionIdx": 3, "stepMin": -0.3, "stepMax": 0.3}}]},
  "gripper": {"attachLinkName": "hand", "offset": [0.1, 0.2, 0.3], "radius": 0.02},
  "links": [{"linkName": "base", "collisionSpheres": [{"origin": [0.3, 1, 0.4], "radius": 0.12}]},
            {"linkName": "arm", "collisionSpheres": [{"origin": [0, 0, 0], "radius": 0.05}]}]})";

std::string collectionText(std::string_view robot, std::string_view objects = "[]") {
  return fmt::format(
      R"({{"collection": {{"collisionRadiusWorkingSet": [0.015, 0.05, 0.12], "freeObjects": {},
          "robots": [{}]}}}})",
      objects, robot);
}

Result<bake::Collection> readText(const std::string& text) {
  const ScratchFolder folder;
  return bake::readCollection(folder.write("c.collection.json", text));
}

TEST(Collections, GiveRadiiObjectsAndTheRobot) {
  const auto collection = readText(collectionText(kRobot, R"([
    {"name": "can", "collisionBox": {"min": [-1, -2, -3], "max": [1, 2, 3]},
     "heldRotationIndex": 8, "generateCollisionSpheresTechnique": "uprightCylinder"},
    {"name": "ball", "collisionBox": {"min": [0, 0, 0], "max": [1, 1, 1]},
     "collisionSpheres": [{"origin": [0.5, 0.5, 0.5], "radius": 0.12}]}])"));
  ASSERT_TRUE(collection.has_value()) << collection.error().message;
  EXPECT_THAT(collection->radii, ElementsAre(0.015, 0.05, 0.12));
  ASSERT_EQ(collection->objects.size(), 2U);
  EXPECT_EQ(collection->objects[0].name, "can");
  EXPECT_THAT(collection->objects[0].box_min, ElementsAre(-1, -2, -3));
  EXPECT_THAT(collection->objects[0].box_max, ElementsAre(1, 2, 3));
  EXPECT_EQ(collection->objects[0].technique, bake::SphereTechnique::kUprightCylinder);
  EXPECT_EQ(collection->objects[1].technique, bake::SphereTechnique::kListed);
  EXPECT_EQ(collection->objects[1].spheres.size(), 1U);
  ASSERT_TRUE(collection->robot.has_value());
  EXPECT_EQ(collection->robot->forward_step, 0.2);
  EXPECT_THAT(collection->warnings, testing::IsEmpty());
}

TEST(Collections, WarnOfKeysThatAreNotUsed) {
  std::string robot = kRobot;
  robot.insert(1, R"("baseOffset": [0, 0.67, 0], )");
  const auto collection = readText(collectionText(robot));
  ASSERT_TRUE(collection.has_value());
  EXPECT_THAT(collection->warnings, ElementsAre("collection.robots[0].baseOffset is not used"));
}

TEST(CollectionRecipes, SayTheSameAsTheirRobot) {
  const auto collection = readText(collectionText(kRobot));
  ASSERT_TRUE(collection.has_value()) << collection.error().message;
  const auto made = bake::recipeFromCollection(*collection, smallRobot());
  ASSERT_TRUE(made.has_value()) << made.error().message;
  const bake::RobotRecipe& recipe = made->recipe;
  EXPECT_EQ(recipe.end_effector.link.name, "hand");
  EXPECT_THAT(recipe.end_effector.grasp_point, ElementsAre(0.1, 0.2, 0.3));
  EXPECT_EQ(recipe.base.forward_step, 0.2);
  EXPECT_EQ(recipe.base.turn_step, 0.1);
  // Children sorted by joint name: locked (0), then shoulder (1), wrist (2), grip (3).
  ASSERT_EQ(recipe.joints.size(), 1U);
  EXPECT_EQ(recipe.joints[0].joint.name, "shoulder");
  EXPECT_EQ(recipe.joints[0].step, 0.3);
  ASSERT_EQ(recipe.start_pose.size(), 1U);
  EXPECT_EQ(recipe.start_pose[0].joint.name, "shoulder");
  EXPECT_EQ(recipe.start_pose[0].position, 0.5);
  const auto* footprint = std::get_if<bake::FootprintCircle>(&recipe.base.footprint);
  ASSERT_NE(footprint, nullptr);
  EXPECT_DOUBLE_EQ(footprint->radius, 0.62);
  EXPECT_THAT(made->warnings,
              ElementsAre("the collection has no camera, and the robot no link 'head_pan_link' for "
                          "the published one"));
}

TEST(CollectionRecipes, SkipTheLinksWithoutSpheres) {
  auto collection = readText(collectionText(kRobot));
  ASSERT_TRUE(collection.has_value());
  collection->robot->start_positions = {};
  const auto made = bake::recipeFromCollection(*collection, smallRobot());
  ASSERT_TRUE(made.has_value()) << made.error().message;
  std::vector<std::string> skipped;
  std::size_t verbatim = 0;
  for (const bake::RecipeLinkSpheres& link : made->recipe.spheres.links) {
    if (link.skip) skipped.push_back(link.link.name);
    verbatim += link.spheres.size();
  }
  EXPECT_THAT(skipped, ElementsAre("hand", "finger", "camera", "lock"));
  EXPECT_EQ(verbatim, 2U);
}

TEST(CollectionRecipes, OfTheWrongRobotAreErrors) {
  auto collection = readText(collectionText(kRobot));
  ASSERT_TRUE(collection.has_value());
  auto wrong_link = *collection;
  wrong_link.robot->links[1].link = "ram";
  const auto link = bake::recipeFromCollection(wrong_link, smallRobot());
  ASSERT_FALSE(link.has_value());
  EXPECT_EQ(link.error().message, "the robot 'small' has no link 'ram'; did you mean 'arm'?");
  auto wrong_count = *collection;
  wrong_count.robot->start_positions = {0, 0};
  const auto count = bake::recipeFromCollection(wrong_count, smallRobot());
  ASSERT_FALSE(count.has_value());
  EXPECT_EQ(
      count.error().message,
      "it has 2 positions, but 'small' has 4 joints that move; is it the collection's robot?");
  auto wrong_joint = *collection;
  wrong_joint.robot->joints[0].dof = 4;
  const auto joint = bake::recipeFromCollection(wrong_joint, smallRobot());
  ASSERT_FALSE(joint.has_value());
  EXPECT_EQ(joint.error().message, "joint number 4 is named, but 'small' has 4 joints that move");
  auto none = *collection;
  none.robot.reset();
  EXPECT_FALSE(bake::recipeFromCollection(none, smallRobot()).has_value());
}

struct Fault {
  const char* name;
  std::string text;
  const char* where;
  const char* message;
};

std::ostream& operator<<(std::ostream& out, const Fault& fault) { return out << fault.name; }

std::string replaced(std::string text, std::string_view from, std::string_view to) {
  return text.replace(text.find(from), from.size(), to);
}

std::string withObject(std::string_view object) {
  return collectionText(kRobot, fmt::format("[{}]", object));
}

std::vector<Fault> faults() {
  const std::string good = collectionText(kRobot);
  return {
      {"NoCollection", "{}", "c.collection.json: collection", "it is missing"},
      {"NoRadii", "{\"collection\": {}}", "c.collection.json: collection.collisionRadiusWorkingSet",
       "it is missing"},
      {"RadiusNotPositive", replaced(good, "0.015", "-0.015"),
       "c.collection.json: collection.collisionRadiusWorkingSet[0]",
       "found -0.015, expected 0.0001 to 10"},
      {"TwoRobots", collectionText(std::string(kRobot) + "," + kRobot),
       "c.collection.json: collection.robots", "it has 2 robots, at most 1 is read"},
      {"NoGripper", replaced(good, "\"gripper\"", "\"griper\""),
       "c.collection.json: collection.robots[0].gripper", "it is missing"},
      {"GripperLinkNotText", replaced(good, "\"hand\"", "7"),
       "c.collection.json: collection.robots[0].gripper.attachLinkName", "expected a string"},
      {"OffsetOfTwo", replaced(good, "[0.1, 0.2, 0.3]", "[0.1, 0.2]"),
       "c.collection.json: collection.robots[0].gripper.offset", "it has 2 numbers, expected 3"},
      {"OffsetNoList", replaced(good, "[0.1, 0.2, 0.3]", "3"),
       "c.collection.json: collection.robots[0].gripper.offset", "expected a list"},
      {"OffsetNotANumber", replaced(good, "[0.1, 0.2, 0.3]", "[0.1, null, 0.3]"),
       "c.collection.json: collection.robots[0].gripper.offset[1]", "expected a number"},
      {"UnevenStep", replaced(good, "\"stepMax\": 0.3", "\"stepMax\": 0.2"),
       "c.collection.json: collection.robots[0].actionMap.joints[0].second",
       "its steps are -0.3 to 0.2, expected -x to x: the same both ways"},
      {"JointNumberNotWhole", replaced(good, "\"first\": 1", "\"first\": 1.5"),
       "c.collection.json: collection.robots[0].actionMap.joints[0]", "expected a whole number"},
      {"BoxInsideOut",
       withObject(R"({"name": "a", "collisionBox": {"min": [1, 0, 0], "max": [0, 1, 1]}})"),
       "c.collection.json: collection.freeObjects[0].collisionBox",
       "its min 1 lies above its max 0"},
      {"UnknownTechnique",
       withObject(R"({"name": "a", "collisionBox": {"min": [0, 0, 0], "max": [1, 1, 1]},
                      "generateCollisionSpheresTechnique": "magic"})"),
       "c.collection.json: collection.freeObjects[0].generateCollisionSpheresTechnique",
       "'magic' is unknown; known are 'box' and 'uprightCylinder'"},
  };
}

class CollectionFaults : public testing::TestWithParam<Fault> {};

TEST_P(CollectionFaults, NameTheirElement) {
  const auto collection = readText(GetParam().text);
  ASSERT_FALSE(collection.has_value());
  EXPECT_EQ(std::filesystem::path(collection.error().where).filename(), GetParam().where);
  EXPECT_EQ(collection.error().message, GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(Texts, CollectionFaults, testing::ValuesIn(faults()),
                         [](const auto& fault) { return fault.param.name; });

TEST(CollectionFiles, ThatAreNoJsonSayWhere) {
  for (const char* text : {"", "{", "{\"collection\": nul}", "[1, 2"}) {
    const auto collection = readText(text);
    ASSERT_FALSE(collection.has_value());
    EXPECT_EQ(collection.error().code, ErrorCode::kInvalidInput);
    EXPECT_THAT(collection.error().message, HasSubstr("it is not JSON: "));
  }
  for (const char* text : {"[]", "3", "null", "\"collection\""}) {
    const auto collection = readText(text);
    ASSERT_FALSE(collection.has_value());
    EXPECT_EQ(collection.error().message, "it is missing");
  }
}

constexpr const char* kPublished = "galactic/data/replicacad_composite.collection.json";
constexpr const char* kPublishedSpot = "galactic/data/replicacad_ycb_spot.collection.json";
constexpr const char* kFetch = "robots/galactic_URDF/opt_fetch/robots/fetch.urdf";

TEST(PublishedCollections, BecomeTheFetchRecipe) {
  if (!hasAsset(kPublished) || !hasAsset(kFetch)) GTEST_SKIP() << "no asset " << kPublished;
  const auto collection = bake::readCollection(assetsFolder() / kPublished);
  ASSERT_TRUE(collection.has_value()) << collection.error().message;
  EXPECT_EQ(collection->objects.size(), 10U);
  bake::RobotImportOptions options;
  options.allow_missing = true;
  const auto robot = bake::importRobot(assetsFolder() / kFetch, options);
  ASSERT_TRUE(robot.has_value()) << robot.error().message;
  const auto made = bake::recipeFromCollection(*collection, *robot);
  ASSERT_TRUE(made.has_value()) << made.error().text();
  const bake::RobotRecipe& recipe = made->recipe;
  std::vector<std::string> joints;
  for (const bake::RecipeJoint& joint : recipe.joints) joints.push_back(joint.joint.name);
  EXPECT_THAT(joints, ElementsAre("shoulder_pan_joint", "shoulder_lift_joint",
                                  "upperarm_roll_joint", "elbow_flex_joint", "forearm_roll_joint",
                                  "wrist_flex_joint", "wrist_roll_joint"));
  EXPECT_EQ(recipe.joints[5].step, 0.262);
  ASSERT_EQ(recipe.start_pose.size(), 2U);
  EXPECT_EQ(recipe.start_pose[0].joint.name, "torso_lift_joint");
  EXPECT_EQ(recipe.start_pose[0].position, 0.2);
  EXPECT_EQ(recipe.start_pose[1].joint.name, "elbow_flex_joint");
  std::size_t spheres = 0;
  for (const bake::RecipeLinkSpheres& link : recipe.spheres.links) spheres += link.spheres.size();
  EXPECT_EQ(spheres, 29U);
  EXPECT_TRUE(recipe.camera.has_value());
}

TEST(PublishedCollections, OfSpotReadWithAWarning) {
  if (!hasAsset(kPublishedSpot)) GTEST_SKIP() << "no asset " << kPublishedSpot;
  const auto collection = bake::readCollection(assetsFolder() / kPublishedSpot);
  ASSERT_TRUE(collection.has_value()) << collection.error().message;
  EXPECT_EQ(collection->objects.size(), 9U);
  EXPECT_THAT(collection->warnings, ElementsAre("collection.robots[0].baseOffset is not used"));
}

}  // namespace
}  // namespace galactic::test::collection_test
