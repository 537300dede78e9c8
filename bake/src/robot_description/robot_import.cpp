#include "galactic/bake/robot_import.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <numbers>
#include <optional>
#include <string_view>
#include <utility>

#include "import/source_files.h"
#include "robot_description/description_process.h"
#include "robot_description/frames.h"
#include "robot_description/geometry_builder.h"
#include "robot_description/link_tree.h"
#include "robot_description/mimics.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

namespace fs = std::filesystem;

/// A revolute joint can turn all the way round, and a prismatic one can move a meter either way.
JointLimits assumedLimits(JointType type) {
  const double most = type == JointType::kRevolute ? std::numbers::pi : 1;
  return {-most, most};
}

/// How the joints above the links follow others.
std::vector<JointMimic> mimicsOf(const RobotDescription& model, const std::vector<TreeLink>& tree) {
  std::vector<JointMimic> mimics;
  for (const TreeLink& link : tree) {
    JointMimic& mimic = mimics.emplace_back();
    if (!link.joint) continue;
    const DescribedJoint& joint = model.joints[*link.joint];
    mimic = {.joint = joint.name,
             .type = joint.type,
             .leader = joint.mimic,
             .multiplier = joint.multiplier,
             .offset = joint.offset};
  }
  return mimics;
}

/// Converts the joints of the model to the runtime's frame, and stores them in the links of
/// `robot`.
void addJoints(const RobotDescription& model, const std::vector<TreeLink>& tree,
               const std::vector<std::optional<Mimic>>& mimics, UpAxis up, SourceRobot& robot) {
  const bool z_up = up == UpAxis::kZ;
  const Affine& up_from_file = z_up ? kYUpFromZUp : kIdentityAffine;
  const Affine& file_from_up = z_up ? kZUpFromYUp : kIdentityAffine;
  for (std::size_t i = 0; i < tree.size(); ++i) {
    SourceLink& link = robot.links[i];
    link.name = model.links[tree[i].link].name;
    link.parent = tree[i].parent;
    link.is_camera = model.links[tree[i].link].is_camera;
    link.parent_from_joint = kIdentityAffine;
    if (!tree[i].joint) continue;
    const DescribedJoint& joint = model.joints[*tree[i].joint];
    link.joint_name = joint.name;
    link.joint_type = joint.type;
    link.parent_from_joint = conjugate(up_from_file, joint.parent_from_joint, file_from_up);
    link.axis = transformed(up_from_file, joint.axis);
    if (joint.has_limits) {
      link.limits = JointLimits{joint.lower, joint.upper};
    } else if (joint.type == JointType::kRevolute || joint.type == JointType::kPrismatic) {
      link.limits = assumedLimits(joint.type);
      link.limits_are_assumed = true;
    }
    link.mimic = mimics[i];
    if (joint.has_rest) link.rest = joint.rest;
  }
}

/// Finds the pairs of links that the model allows to touch.
void addTouching(const RobotDescription& model, SourceRobot& robot) {
  const auto index_of = [&](const std::string& name) {
    return static_cast<std::uint32_t>(std::ranges::find(robot.links, name, &SourceLink::name) -
                                      robot.links.begin());
  };
  for (const auto& [first, second] : model.touching) {
    robot.may_touch.emplace_back(index_of(first), index_of(second));
  }
}

/// Sorts and hashes the robot's file and the files that it and its meshes name.
Result<void> finishFiles(const RobotDescription& model, SourceRobot& robot, const fs::path& path) {
  robot.read.files.push_back({.name = nameRelativeTo(path, path)});
  for (const std::string& file : model.included) {
    robot.read.files.push_back({.name = nameRelativeTo(path, file)});
  }
  for (const std::string& file : model.absent) {
    robot.read.absent.push_back(nameRelativeTo(path, file));
  }
  return hashFiles(robot.read.files, path);
}

}  // namespace

std::vector<fs::path> rosPackagePath() {
  std::vector<fs::path> folders;
  const char* text = std::getenv("ROS_PACKAGE_PATH");
  std::string_view rest = text == nullptr ? "" : text;
  while (!rest.empty()) {
    const std::size_t colon = rest.find(':');
    if (colon != 0) folders.emplace_back(rest.substr(0, colon));
    rest.remove_prefix(colon == std::string_view::npos ? rest.size() : colon + 1);
  }
  return folders;
}

Result<SourceRobot> importRobot(const fs::path& path, const RobotImportOptions& options) {
  if (options.up != UpAxis::kZ && options.up != UpAxis::kY) {
    return fail(ErrorCode::kUnsupported, path.string(),
                "the up axis of a robot can only be Z or Y; turn the robot's root otherwise");
  }
  ASSIGN_OR_RETURN(auto model, readDescription(path, {.allow_outside = options.allow_outside},
                                               options.time_limit));
  SourceRobot robot;
  robot.name = model.name;
  robot.warnings = std::move(model.warnings);
  const std::string where = path.string();
  ASSIGN_OR_RETURN(const auto tree, orderTree(model, where));
  RETURN_IF_ERROR(checkJoints(model, where, robot.warnings));
  ASSIGN_OR_RETURN(const auto mimics, resolveMimics(mimicsOf(model, tree), where));
  robot.links.resize(tree.size());
  addJoints(model, tree, mimics, options.up, robot);
  addTouching(model, robot);
  GeometryBuilder geometry(path, model.meshes, options, robot);
  for (std::size_t i = 0; i < tree.size(); ++i) {
    RETURN_IF_ERROR(geometry.addShapes(model.links[tree[i].link], robot.links[i]));
  }
  geometry.noteSearch();
  RETURN_IF_ERROR(finishFiles(model, robot, path));
  return robot;
}

}  // namespace galactic::bake
