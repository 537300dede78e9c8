#include "recipe/collection_import.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string_view>
#include <utility>

#include "json/json_reader.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxCollectionBytes = std::size_t{64} << 20U;
constexpr double kFarthest = 100;
constexpr double kLargestRadius = 10;
constexpr double kLargestStep = 3.2;
constexpr double kLargestPosition = 1e6;
constexpr std::uint32_t kMostDofs = 10'000;

/// What has been read of a collection so far, and the first error.
class CollectionReader {
 public:
  explicit CollectionReader(const fs::path& path) : json_(path.string()) {}

  Result<Collection> read(const Json& root);

 private:
  std::array<double, 3> point(const JsonNode& node) { return json_.vector<3>(node, kFarthest); }
  void readObject(const JsonNode& node);
  std::vector<HandSphere> readSpheres(const JsonNode& list);
  void readRobot(const JsonNode& node);
  void readActions(const JsonNode& actions, CollectionRobot& robot);
  /// The farthest move of an action, which must be the same in both directions.
  double readStep(const JsonNode& action);

  JsonReader json_;
  Collection collection_;
};

std::vector<HandSphere> CollectionReader::readSpheres(const JsonNode& list) {
  std::vector<HandSphere> spheres;
  for (const JsonNode& sphere : json_.elements(list)) {
    json_.onlyKnown(sphere, {"origin", "radius"});
    const auto center = point(json_.require(sphere, "origin"));
    const double radius = json_.number(json_.require(sphere, "radius"), 1e-4, kLargestRadius);
    spheres.push_back({.center = center, .radius = radius});
  }
  return spheres;
}

void CollectionReader::readObject(const JsonNode& node) {
  json_.onlyKnown(node, {"name", "collisionBox", "generateCollisionSpheresTechnique",
                         "collisionSpheres", "heldRotationIndex"});
  CollectionObject object;
  object.name = json_.text(json_.require(node, "name"));
  const JsonNode box = json_.require(node, "collisionBox");
  object.box_min = point(json_.require(box, "min"));
  object.box_max = point(json_.require(box, "max"));
  for (std::size_t i = 0; i < 3; ++i) {
    if (object.box_min[i] > object.box_max[i]) {
      json_.error(box.place, fmt::format("its min {} lies above its max {}", object.box_min[i],
                                         object.box_max[i]));
    }
  }
  object.spheres = readSpheres(json_.member(node, "collisionSpheres"));
  const JsonNode technique = json_.member(node, "generateCollisionSpheresTechnique");
  const std::string name = json_.text(technique);
  if (name == "box") {
    object.technique = SphereTechnique::kBox;
  } else if (name == "uprightCylinder") {
    object.technique = SphereTechnique::kUprightCylinder;
  } else if (!name.empty()) {
    json_.error(technique.place,
                fmt::format("'{}' is unknown; known are 'box' and 'uprightCylinder'", name));
  }
  if (!name.empty() && !object.spheres.empty()) {
    json_.error(node.place, "it has both spheres and a technique to make them; keep one");
  }
  collection_.objects.push_back(std::move(object));
}

double CollectionReader::readStep(const JsonNode& action) {
  json_.onlyKnown(action, {"actionIdx", "stepMin", "stepMax"});
  const JsonNode min_node = json_.member(action, "stepMin");
  const JsonNode max_node = json_.member(action, "stepMax");
  const double min =
      min_node.json == nullptr ? -1 : json_.number(min_node, -kLargestStep, kLargestStep);
  const double max =
      max_node.json == nullptr ? 1 : json_.number(max_node, -kLargestStep, kLargestStep);
  if (max <= 0 || min != -max) {
    json_.error(
        action.place,
        fmt::format("its steps are {} to {}, expected -x to x: the same both ways", min, max));
  }
  return max;
}

void CollectionReader::readActions(const JsonNode& actions, CollectionRobot& robot) {
  if (actions.json == nullptr) return;
  json_.onlyKnown(actions, {"numActions", "baseMove", "baseRotate", "graspRelease", "joints"});
  const JsonNode move = json_.member(actions, "baseMove");
  const JsonNode rotate = json_.member(actions, "baseRotate");
  if (move.json != nullptr) robot.forward_step = readStep(move);
  if (rotate.json != nullptr) robot.turn_step = readStep(rotate);
  for (const JsonNode& joint : json_.elements(json_.member(actions, "joints"))) {
    const double dof = json_.number(json_.require(joint, "first"), 0, kMostDofs);
    if (dof != std::floor(dof)) json_.error(joint.place, "expected a whole number");
    robot.joints.push_back(
        {.dof = static_cast<std::uint32_t>(dof), .step = readStep(json_.require(joint, "second"))});
  }
}

void CollectionReader::readRobot(const JsonNode& node) {
  json_.onlyKnown(node, {"urdfFilepath", "startJointPositions", "actionMap", "gripper", "links"});
  CollectionRobot robot;
  robot.urdf = json_.text(json_.require(node, "urdfFilepath"));
  for (const JsonNode& position : json_.elements(json_.member(node, "startJointPositions"))) {
    robot.start_positions.push_back(json_.number(position, -kLargestPosition, kLargestPosition));
  }
  const JsonNode gripper = json_.require(node, "gripper");
  robot.gripper_link = json_.text(json_.require(gripper, "attachLinkName"));
  robot.gripper_offset = point(json_.require(gripper, "offset"));
  robot.gripper_radius = json_.number(json_.require(gripper, "radius"), 1e-4, kLargestRadius);
  readActions(json_.member(node, "actionMap"), robot);
  for (const JsonNode& link : json_.elements(json_.require(node, "links"))) {
    LinkSpheres& set = robot.links.emplace_back();
    set.link = json_.text(json_.require(link, "linkName"));
    set.spheres = readSpheres(json_.require(link, "collisionSpheres"));
  }
  collection_.robot = std::move(robot);
}

Result<Collection> CollectionReader::read(const Json& root) {
  const JsonNode collection = json_.require({&root, ""}, "collection");
  json_.onlyKnown(collection, {"collisionRadiusWorkingSet", "freeObjects", "robots"});
  for (const JsonNode& radius :
       json_.elements(json_.require(collection, "collisionRadiusWorkingSet"))) {
    collection_.radii.push_back(json_.number(radius, 1e-4, kLargestRadius));
  }
  for (const JsonNode& object : json_.elements(json_.member(collection, "freeObjects"))) {
    readObject(object);
    if (json_.failed()) break;
  }
  const auto robots = json_.elements(json_.member(collection, "robots"));
  if (robots.size() > 1) {
    json_.error("collection.robots",
                fmt::format("it has {} robots, at most 1 is read", robots.size()));
  }
  if (!robots.empty()) readRobot(robots.front());
  if (json_.failed()) return json_.failure();
  collection_.source = json_.file();
  collection_.warnings = json_.warnings();
  return std::move(collection_);
}

/// The links below joints that have a position, in the order in which the published simulator
/// numbers them.
std::vector<std::size_t> dofOrder(const SourceRobot& robot) {
  std::vector<std::vector<std::size_t>> children(robot.links.size());
  for (std::size_t i = 1; i < robot.links.size(); ++i) {
    children[static_cast<std::size_t>(robot.links[i].parent)].push_back(i);
  }
  for (auto& list : children) {
    // Descending, because the stack below reverses the order. No two joints have the same name.
    std::sort(list.begin(), list.end(), [&](std::size_t a, std::size_t b) {
      return robot.links[a].joint_name > robot.links[b].joint_name;
    });
  }
  std::vector<std::size_t> order;
  std::vector<std::size_t> open{0};
  while (!open.empty()) {
    const std::size_t link = open.back();
    open.pop_back();
    if (link != 0 && positionCount(robot.links[link].joint_type) == 1) order.push_back(link);
    open.insert(open.end(), children[link].begin(), children[link].end());
  }
  return order;
}

/// The camera with which the published policies were trained; the collection file does not contain
/// it.
constexpr const char* kCameraLink = "head_pan_link";
constexpr std::array<double, 3> kCameraPosition{0.2, 0.2, 0};
constexpr double kCameraDownPitch = 0.3490658503988659;    // 20 degrees
constexpr double kCameraFieldOfView = 1.0471975511965976;  // 60 degrees, square images

RecipeCamera publishedCamera(const std::string& where) {
  const double c = std::cos(kCameraDownPitch);
  const double s = std::sin(kCameraDownPitch);
  const auto& p = kCameraPosition;
  return {.link = {kCameraLink, where},
          .link_from_camera = {c, s, 0, p[0], -s, c, 0, p[1], 0, 0, 1, p[2]},
          .vertical_fov = kCameraFieldOfView};
}

/// Radius of the circle around the spheres of the root link; other links may move away from it.
double footprintRadius(const CollectionRobot& robot, const std::string& root) {
  double radius = 0;
  for (const LinkSpheres& link : robot.links) {
    if (link.link != root) continue;
    for (const HandSphere& sphere : link.spheres) {
      radius = std::max(radius, std::hypot(sphere.center[0], sphere.center[2]) + sphere.radius);
    }
  }
  return radius;
}

Result<void> addJoints(const CollectionRobot& from, const SourceRobot& robot,
                       const std::string& where, RobotRecipe& recipe) {
  const std::vector<std::size_t> order = dofOrder(robot);
  const std::string place = where + ": collection.robots[0]";
  if (!from.start_positions.empty() && from.start_positions.size() != order.size()) {
    return fail(ErrorCode::kInvalidInput, place + ".startJointPositions",
                fmt::format("it has {} positions, but '{}' has {} joints that move; is it the "
                            "collection's robot?",
                            from.start_positions.size(), robot.name, order.size()));
  }
  for (const CollectionJoint& joint : from.joints) {
    if (joint.dof >= order.size()) {
      return fail(ErrorCode::kInvalidInput, place + ".actionMap.joints",
                  fmt::format("joint number {} is named, but '{}' has {} joints that move",
                              joint.dof, robot.name, order.size()));
    }
    recipe.joints.push_back(
        {.joint = {robot.links[order[joint.dof]].joint_name, place + ".actionMap.joints"},
         .step = joint.step,
         .min = {},
         .max = {}});
  }
  for (std::size_t i = 0; i < from.start_positions.size(); ++i) {
    if (from.start_positions[i] == 0) continue;
    recipe.start_pose.push_back(
        {.joint = {robot.links[order[i]].joint_name, place + ".startJointPositions"},
         .position = from.start_positions[i]});
  }
  return {};
}

void addSpheres(const CollectionRobot& from, const SourceRobot& robot, const std::string& where,
                RobotRecipe& recipe) {
  std::set<std::string_view> listed;
  for (const LinkSpheres& set : from.links) {
    RecipeLinkSpheres& link = recipe.spheres.links.emplace_back();
    link.link = {set.link, where + ": collection.robots[0].links"};
    link.spheres = set.spheres;
    link.skip = set.spheres.empty();
    listed.insert(set.link);
  }
  for (const SourceLink& link : robot.links) {
    if (listed.contains(link.name)) continue;
    RecipeLinkSpheres& skipped = recipe.spheres.links.emplace_back();
    skipped.link = {link.name, where};
    skipped.skip = true;
  }
}

}  // namespace

Result<Collection> readCollection(const fs::path& path) {
  ASSIGN_OR_RETURN(const auto json, readJsonFile(path, {.what = "a collection",
                                                        .suffix = ".collection.json",
                                                        .max_bytes = kMaxCollectionBytes}));
  return CollectionReader(path).read(json);
}

Result<CollectionRecipe> recipeFromCollection(const Collection& collection,
                                              const SourceRobot& robot) {
  if (!collection.robot || robot.links.empty()) {
    return fail(ErrorCode::kInvalidInput, collection.source,
                "there is no robot to make a recipe for; give a collection with a robot and its "
                "URDF");
  }
  const CollectionRobot& from = *collection.robot;
  CollectionRecipe result;
  RobotRecipe& recipe = result.recipe;
  recipe.name = robot.name;
  recipe.source = collection.source;
  recipe.end_effector = {
      .link = {from.gripper_link, collection.source + ": collection.robots[0].gripper"},
      .grasp_point = from.gripper_offset,
      .grasp_radius = from.gripper_radius};
  recipe.base.forward_step = from.forward_step.value_or(recipe.base.forward_step);
  recipe.base.turn_step = from.turn_step.value_or(recipe.base.turn_step);
  const double radius = footprintRadius(from, robot.links.front().name);
  recipe.base.footprint = FootprintCircle{radius};
  if (radius == 0) {
    result.warnings.push_back(
        fmt::format("the root link '{}' has no spheres, so the footprint is a "
                    "point",
                    robot.links.front().name));
  }
  const bool has_camera = std::any_of(robot.links.begin(), robot.links.end(),
                                      [](const auto& link) { return link.name == kCameraLink; });
  if (has_camera) {
    recipe.camera = publishedCamera(collection.source);
  } else {
    result.warnings.push_back(
        fmt::format("the collection has no camera, and the robot no link '{}' "
                    "for the published one",
                    kCameraLink));
  }
  RETURN_IF_ERROR(addJoints(from, robot, collection.source, recipe));
  addSpheres(from, robot, collection.source, recipe);
  RETURN_IF_ERROR(checkRecipe(recipe, robot));
  return result;
}

}  // namespace galactic::bake
