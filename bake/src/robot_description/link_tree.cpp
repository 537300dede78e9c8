#include "robot_description/link_tree.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string_view>

#include "galactic/bake/triangle_mesh.h"
#include "import/affine.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

/// The direction of shorter axes is meaningless.
constexpr double kShortestAxis = 1e-6;
/// Axes are often written with three digits, which causes no warning.
constexpr double kAxisTolerance = 1e-3;
/// Limits of revolute joints in this range are more likely degrees than radians: few joints turn
/// twice either way, and those that turn endlessly have limits far beyond.
constexpr double kFewestDegrees = 4 * std::numbers::pi;
constexpr double kMostDegrees = 720;

tl::unexpected<Error> invalid(const std::string& where, std::string message) {
  return fail(ErrorCode::kInvalidInput, where, std::move(message));
}

std::string jointPlace(const std::string& where, const DescribedJoint& joint) {
  return fmt::format("{}: joint '{}'", where, joint.name);
}

/// For each link, the joints to its children and the joint to its parent.
class Tree {
 public:
  Tree(const RobotDescription& model, const std::string& where) : model_(model), where_(where) {}

  Result<std::vector<TreeLink>> order();

 private:
  Result<void> connect();
  Result<void> connectJoint(std::size_t index);
  [[nodiscard]] Result<std::size_t> findRoot() const;
  [[nodiscard]] std::vector<TreeLink> walk(std::size_t root) const;
  [[nodiscard]] std::string namesOf(const std::vector<std::size_t>& links) const;

  const RobotDescription& model_;
  const std::string& where_;
  std::map<std::string_view, std::size_t> link_of_name_;
  std::vector<std::vector<std::size_t>> joints_below_;
  std::vector<std::optional<std::size_t>> joint_above_;
};

Result<void> Tree::connectJoint(std::size_t index) {
  const DescribedJoint& joint = model_.joints[index];
  const auto parent = link_of_name_.find(joint.parent);
  const auto child = link_of_name_.find(joint.child);
  for (const auto& [end, found, role] :
       {std::tuple(&joint.parent, parent, "parent"), std::tuple(&joint.child, child, "child")}) {
    if (found == link_of_name_.end()) {
      return invalid(jointPlace(where_, joint),
                     fmt::format("its {} link '{}' does not exist; add the link or correct the "
                                 "name",
                                 role, *end));
    }
  }
  if (parent->second == child->second) {
    return invalid(
        jointPlace(where_, joint),
        fmt::format("it joins link '{}' to itself; a joint needs two links", joint.parent));
  }
  std::optional<std::size_t>& above = joint_above_[child->second];
  if (above) {
    return invalid(fmt::format("{}: link '{}'", where_, joint.child),
                   fmt::format("two joints have it as their child, '{}' and '{}'; a robot is a "
                               "tree: remove one",
                               model_.joints[*above].name, joint.name));
  }
  above = index;
  joints_below_[parent->second].push_back(index);
  return {};
}

Result<void> Tree::connect() {
  for (std::size_t i = 0; i < model_.links.size(); ++i) {
    if (!link_of_name_.try_emplace(model_.links[i].name, i).second) {
      return invalid(where_,
                     fmt::format("link '{}' is there twice; rename one", model_.links[i].name));
    }
  }
  joints_below_.resize(model_.links.size());
  joint_above_.resize(model_.links.size());
  for (std::size_t i = 0; i < model_.joints.size(); ++i) {
    if (auto connected = connectJoint(i); !connected) return connected;
  }
  return {};
}

std::string Tree::namesOf(const std::vector<std::size_t>& links) const {
  constexpr std::size_t kMostNames = 8;
  std::string names;
  for (std::size_t i = 0; i < std::min(links.size(), kMostNames); ++i) {
    names += fmt::format("{}'{}'", i == 0 ? "" : ", ", model_.links[links[i]].name);
  }
  if (links.size() > kMostNames) names += fmt::format(" and {} more", links.size() - kMostNames);
  return names;
}

Result<std::size_t> Tree::findRoot() const {
  std::vector<std::size_t> roots;
  for (std::size_t i = 0; i < model_.links.size(); ++i) {
    if (!joint_above_[i]) roots.push_back(i);
  }
  if (roots.empty()) {
    return invalid(where_, model_.links.empty()
                               ? "it has no links"
                               : "every link is the child of a joint, so there is no root: the "
                                 "joints form a loop; a robot is a tree");
  }
  if (roots.size() > 1) {
    return invalid(where_, fmt::format("it has {} roots, links {}; a robot is one tree: join them "
                                       "with (fixed) joints",
                                       roots.size(), namesOf(roots)));
  }
  return roots.front();
}

std::vector<TreeLink> Tree::walk(std::size_t root) const {
  std::vector<TreeLink> ordered;
  std::vector<TreeLink> open{{.link = root, .parent = -1, .joint = std::nullopt}};
  while (!open.empty()) {
    const TreeLink at = open.back();
    open.pop_back();
    const int position = static_cast<int>(ordered.size());
    ordered.push_back(at);
    const auto& below = joints_below_[at.link];
    for (auto joint = below.rbegin(); joint != below.rend(); ++joint) {
      const std::size_t child = link_of_name_.at(model_.joints[*joint].child);
      open.push_back({.link = child, .parent = position, .joint = *joint});
    }
  }
  return ordered;
}

Result<std::vector<TreeLink>> Tree::order() {
  RETURN_IF_ERROR(connect());
  ASSIGN_OR_RETURN(const auto root, findRoot());
  std::vector<TreeLink> ordered = walk(root);
  if (ordered.size() == model_.links.size()) return ordered;
  std::vector<bool> reached(model_.links.size(), false);
  for (const TreeLink& link : ordered) reached[link.link] = true;
  std::vector<std::size_t> left;
  for (std::size_t i = 0; i < reached.size(); ++i) {
    if (!reached[i]) left.push_back(i);
  }
  return invalid(where_, fmt::format("links {} hang in a loop of joints, apart from the root '{}'; "
                                     "a robot is one tree",
                                     namesOf(left), model_.links[root].name));
}

Result<void> checkAxis(DescribedJoint& joint, const std::string& place,
                       std::vector<std::string>& warnings) {
  if (joint.type == JointType::kFixed || joint.type == JointType::kFloating) {
    joint.axis = {1, 0, 0};
    return {};
  }
  const double length = std::hypot(joint.axis[0], joint.axis[1], joint.axis[2]);
  if (length < kShortestAxis) {
    return invalid(place, fmt::format("its axis ({} {} {}) has no direction; give a unit vector",
                                      joint.axis[0], joint.axis[1], joint.axis[2]));
  }
  if (std::abs(length - 1) > kAxisTolerance) {
    warnings.push_back(
        fmt::format("joint '{}': its axis ({} {} {}) is not of unit length; only its "
                    "direction counts",
                    joint.name, joint.axis[0], joint.axis[1], joint.axis[2]));
  }
  for (double& component : joint.axis) component /= length;
  return {};
}

Result<void> checkLimits(DescribedJoint& joint, const std::string& place,
                         std::vector<std::string>& warnings) {
  const bool limited = joint.type == JointType::kRevolute || joint.type == JointType::kPrismatic;
  if (!limited) {
    if (joint.type == JointType::kContinuous && (joint.lower != 0 || joint.upper != 0)) {
      warnings.push_back(
          fmt::format("joint '{}': it is continuous, so its limits {} to {} are not "
                      "used",
                      joint.name, joint.lower, joint.upper));
    }
    joint.has_limits = false;
    return {};
  }
  if (!joint.has_limits) return {};
  if (joint.lower > joint.upper) {
    return invalid(place, fmt::format("its lower limit {} is above its upper limit {}; swap or "
                                      "correct them",
                                      joint.lower, joint.upper));
  }
  const double farthest = std::max(std::abs(joint.lower), std::abs(joint.upper));
  if (joint.type == JointType::kRevolute && farthest > kFewestDegrees && farthest <= kMostDegrees) {
    warnings.push_back(
        fmt::format("joint '{}': its limits {} to {} are taken as radians, more than two turns; if "
                    "they are degrees, convert them",
                    joint.name, joint.lower, joint.upper));
  }
  return {};
}

}  // namespace

Result<std::vector<TreeLink>> orderTree(const RobotDescription& model, const std::string& where) {
  return Tree(model, where).order();
}

Result<void> checkJoints(RobotDescription& model, const std::string& where,
                         std::vector<std::string>& warnings) {
  for (DescribedJoint& joint : model.joints) {
    const std::string place = jointPlace(where, joint);
    const auto& frame = joint.parent_from_joint;
    const bool finite = isFinite(frame) && std::isfinite(joint.lower) &&
                        std::isfinite(joint.upper) && std::isfinite(joint.axis[0]) &&
                        std::isfinite(joint.axis[1]) && std::isfinite(joint.axis[2]);
    if (!finite) {
      return invalid(place,
                     "its origin, axis or limits have a number that is not finite; correct "
                     "it");
    }
    const double farthest = std::max({std::abs(frame[3]), std::abs(frame[7]), std::abs(frame[11])});
    if (farthest > kMaxCoordinate) {
      return invalid(place,
                     fmt::format("its origin is {} m away, at most {} m are possible; is the "
                                 "unit meters?",
                                 farthest, kMaxCoordinate));
    }
    if (auto checked = checkAxis(joint, place, warnings); !checked) return checked;
    if (auto checked = checkLimits(joint, place, warnings); !checked) return checked;
  }
  return {};
}

}  // namespace galactic::bake
