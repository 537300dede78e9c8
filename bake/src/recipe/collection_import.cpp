#include "galactic/bake/collection_import.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>

#include "galactic/mapped_file.h"

namespace galactic::bake {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr std::size_t kMaxCollectionBytes = std::size_t{64} << 20U;
constexpr double kFarthest = 100;
constexpr double kLargestRadius = 10;
constexpr double kLargestStep = 3.2;
constexpr double kLargestPosition = 1e6;
constexpr std::uint32_t kMostDofs = 10'000;

/// What is read of a collection, and the first error.
class CollectionReader {
 public:
  explicit CollectionReader(const fs::path& path) : path_(path) {}

  Result<Collection> read(const Json& root);

 private:
  /// A JSON value and where it stands, for example "collection.robots[0].gripper".
  struct Node {
    const Json* json = nullptr;
    std::string place;
  };

  void error(const std::string& place, std::string message) {
    if (error_) return;
    error_ = Error{ErrorCode::kInvalidInput, fmt::format("{}: {}", path_.string(), place),
                   std::move(message)};
  }
  /// The member, or a null node when it is absent.
  static Node member(const Node& object, const char* key) {
    Node node{nullptr, object.place.empty() ? key : fmt::format("{}.{}", object.place, key)};
    if (object.json == nullptr || !object.json->is_object()) return node;
    const auto found = object.json->find(key);
    if (found != object.json->end()) node.json = &*found;
    return node;
  }
  Node require(const Node& object, const char* key) {
    Node node = member(object, key);
    if (node.json == nullptr && !error_) error(node.place, "it is missing");
    return node;
  }
  std::vector<Node> elements(const Node& list) {
    std::vector<Node> nodes;
    if (list.json == nullptr) return nodes;
    if (!list.json->is_array()) error(list.place, "it is wanted as a list");
    if (error_) return nodes;
    for (std::size_t i = 0; i < list.json->size(); ++i) {
      nodes.push_back({&(*list.json)[i], fmt::format("{}[{}]", list.place, i)});
    }
    return nodes;
  }
  std::string text(const Node& node) {
    if (node.json != nullptr && node.json->is_string()) return node.json->get<std::string>();
    if (node.json != nullptr) error(node.place, "it is wanted as text");
    return {};
  }
  double number(const Node& node, double min, double max) {
    if (node.json == nullptr) return 0;
    if (!node.json->is_number()) {
      error(node.place, "it is wanted as a number");
      return 0;
    }
    const double value = node.json->get<double>();
    if (value >= min && value <= max) return value;
    error(node.place, fmt::format("{}: wanted {} to {}", value, min, max));
    return 0;
  }
  std::array<double, 3> vector(const Node& node) {
    std::array<double, 3> values{};
    const auto list = elements(node);
    if (node.json == nullptr || error_) return values;
    if (list.size() != values.size()) {
      error(node.place, fmt::format("it has {} numbers, wanted 3", list.size()));
      return values;
    }
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i] = number(list[i], -kFarthest, kFarthest);
    }
    return values;
  }
  void onlyKnown(const Node& object, std::initializer_list<std::string_view> known);

  void readObject(const Node& object);
  std::vector<HandSphere> readSpheres(const Node& list);
  void readRobot(const Node& robot);
  void readActions(const Node& actions, CollectionRobot& robot);
  /// The farthest move of an action, which is the same both ways.
  double readStep(const Node& action);

  const fs::path& path_;
  Collection collection_;
  std::optional<Error> error_;
};

void CollectionReader::onlyKnown(const Node& object,
                                 std::initializer_list<std::string_view> known) {
  if (object.json == nullptr || !object.json->is_object()) return;
  for (const auto& [key, value] : object.json->items()) {
    if (std::find(known.begin(), known.end(), key) != known.end()) continue;
    collection_.warnings.push_back(fmt::format("{}.{} is not used", object.place, key));
  }
}

std::vector<HandSphere> CollectionReader::readSpheres(const Node& list) {
  std::vector<HandSphere> spheres;
  for (const Node& sphere : elements(list)) {
    onlyKnown(sphere, {"origin", "radius"});
    const auto centre = vector(require(sphere, "origin"));
    const double radius = number(require(sphere, "radius"), 1e-4, kLargestRadius);
    spheres.push_back({.centre = centre, .radius = radius});
  }
  return spheres;
}

void CollectionReader::readObject(const Node& node) {
  onlyKnown(node, {"name", "collisionBox", "generateCollisionSpheresTechnique", "collisionSpheres",
                   "heldRotationIndex"});
  CollectionObject object;
  object.name = text(require(node, "name"));
  const Node box = require(node, "collisionBox");
  object.box_min = vector(require(box, "min"));
  object.box_max = vector(require(box, "max"));
  for (std::size_t i = 0; i < 3; ++i) {
    if (object.box_min[i] > object.box_max[i]) {
      error(box.place,
            fmt::format("its min {} lies above its max {}", object.box_min[i], object.box_max[i]));
    }
  }
  object.spheres = readSpheres(member(node, "collisionSpheres"));
  const Node technique = member(node, "generateCollisionSpheresTechnique");
  const std::string name = text(technique);
  if (name == "box") {
    object.technique = SphereTechnique::kBox;
  } else if (name == "uprightCylinder") {
    object.technique = SphereTechnique::kUprightCylinder;
  } else if (!name.empty()) {
    error(technique.place,
          fmt::format("'{}' is unknown; known are 'box' and 'uprightCylinder'", name));
  }
  if (!name.empty() && !object.spheres.empty()) {
    error(node.place, "it has both spheres and a technique to make them; keep one");
  }
  collection_.objects.push_back(std::move(object));
}

double CollectionReader::readStep(const Node& action) {
  onlyKnown(action, {"actionIdx", "stepMin", "stepMax"});
  const Node min_node = member(action, "stepMin");
  const Node max_node = member(action, "stepMax");
  const double min = min_node.json == nullptr ? -1 : number(min_node, -kLargestStep, kLargestStep);
  const double max = max_node.json == nullptr ? 1 : number(max_node, -kLargestStep, kLargestStep);
  if (max <= 0 || min != -max) {
    error(action.place,
          fmt::format("its steps {} to {} are wanted as -x to x, the same both ways", min, max));
  }
  return max;
}

void CollectionReader::readActions(const Node& actions, CollectionRobot& robot) {
  if (actions.json == nullptr) return;
  onlyKnown(actions, {"numActions", "baseMove", "baseRotate", "graspRelease", "joints"});
  const Node move = member(actions, "baseMove");
  const Node rotate = member(actions, "baseRotate");
  if (move.json != nullptr) robot.forward_step = readStep(move);
  if (rotate.json != nullptr) robot.turn_step = readStep(rotate);
  for (const Node& joint : elements(member(actions, "joints"))) {
    const double dof = number(require(joint, "first"), 0, kMostDofs);
    if (dof != std::floor(dof)) error(joint.place, "its number is wanted whole");
    robot.joints.push_back(
        {.dof = static_cast<std::uint32_t>(dof), .step = readStep(require(joint, "second"))});
  }
}

void CollectionReader::readRobot(const Node& node) {
  onlyKnown(node, {"urdfFilepath", "startJointPositions", "actionMap", "gripper", "links"});
  CollectionRobot robot;
  robot.urdf = text(require(node, "urdfFilepath"));
  for (const Node& position : elements(member(node, "startJointPositions"))) {
    robot.start_positions.push_back(number(position, -kLargestPosition, kLargestPosition));
  }
  const Node gripper = require(node, "gripper");
  robot.gripper_link = text(require(gripper, "attachLinkName"));
  robot.gripper_offset = vector(require(gripper, "offset"));
  robot.gripper_radius = number(require(gripper, "radius"), 1e-4, kLargestRadius);
  readActions(member(node, "actionMap"), robot);
  for (const Node& link : elements(require(node, "links"))) {
    LinkSpheres& set = robot.links.emplace_back();
    set.link = text(require(link, "linkName"));
    set.spheres = readSpheres(require(link, "collisionSpheres"));
  }
  collection_.robot = std::move(robot);
}

Result<Collection> CollectionReader::read(const Json& root) {
  const Node collection = require({&root, ""}, "collection");
  onlyKnown(collection, {"collisionRadiusWorkingSet", "freeObjects", "robots"});
  for (const Node& radius : elements(require(collection, "collisionRadiusWorkingSet"))) {
    collection_.radii.push_back(number(radius, 1e-4, kLargestRadius));
  }
  for (const Node& object : elements(member(collection, "freeObjects"))) {
    readObject(object);
    if (error_) break;
  }
  const auto robots = elements(member(collection, "robots"));
  if (robots.size() > 1) {
    error("collection.robots", fmt::format("it has {} robots, at most 1 is read", robots.size()));
  }
  if (!robots.empty()) readRobot(robots.front());
  if (error_) return tl::unexpected(std::move(*error_));
  collection_.source = path_.string();
  return std::move(collection_);
}

bool hasPosition(JointType type) {
  return type == JointType::kRevolute || type == JointType::kContinuous ||
         type == JointType::kPrismatic;
}

/// The links below the joints that have a position, in the order in which the published simulator
/// numbers them.
std::vector<std::size_t> dofOrder(const SourceRobot& robot) {
  std::vector<std::vector<std::size_t>> children(robot.links.size());
  for (std::size_t i = 1; i < robot.links.size(); ++i) {
    children[static_cast<std::size_t>(robot.links[i].parent)].push_back(i);
  }
  for (auto& list : children) {
    // Descending, because the stack below turns the order round. Joint names differ.
    std::sort(list.begin(), list.end(), [&](std::size_t a, std::size_t b) {
      return robot.links[a].joint_name > robot.links[b].joint_name;
    });
  }
  std::vector<std::size_t> order;
  std::vector<std::size_t> open{0};
  while (!open.empty()) {
    const std::size_t link = open.back();
    open.pop_back();
    if (link != 0 && hasPosition(robot.links[link].joint_type)) order.push_back(link);
    open.insert(open.end(), children[link].begin(), children[link].end());
  }
  return order;
}

/// The camera with which the published policies were trained; their file does not name it.
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

/// The circle around the spheres of the root link; those of other links may be anywhere.
double footprintRadius(const CollectionRobot& robot, const std::string& root) {
  double radius = 0;
  for (const LinkSpheres& link : robot.links) {
    if (link.link != root) continue;
    for (const HandSphere& sphere : link.spheres) {
      radius = std::max(radius, std::hypot(sphere.centre[0], sphere.centre[2]) + sphere.radius);
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
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) {
    return fail(ErrorCode::kIo, path.string(),
                "it is a folder; give the path of a .collection.json file");
  }
  const auto file = MappedFile::open(path);
  if (!file) return tl::unexpected(file.error());
  const std::string_view text(reinterpret_cast<const char*>(file->bytes().data()),
                              file->bytes().size());
  if (text.size() > kMaxCollectionBytes) {
    return fail(ErrorCode::kInvalidInput, path.string(),
                fmt::format("it has {} bytes, at most {} are read; is it a collection?",
                            text.size(), kMaxCollectionBytes));
  }
  try {
    return CollectionReader(path).read(Json::parse(text));
  } catch (const Json::exception& error) {
    return fail(ErrorCode::kInvalidInput, path.string(),
                fmt::format("it is not JSON: {}", error.what()));
  }
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
  if (auto added = addJoints(from, robot, collection.source, recipe); !added) {
    return tl::unexpected(added.error());
  }
  addSpheres(from, robot, collection.source, recipe);
  if (auto checked = checkRecipe(recipe, robot); !checked) {
    return tl::unexpected(checked.error());
  }
  return result;
}

}  // namespace galactic::bake
