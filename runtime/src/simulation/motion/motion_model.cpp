#include "simulation/motion/motion_model.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "support/try.h"

namespace galactic::simulation {
namespace {

/// The rotation that takes +X to the unit vector `axis`.
Quat turnXTo(const Vec3& axis) {
  // The half-way quaternion (1 + x . axis, x cross axis); for the opposite direction, half a turn
  // about Y.
  constexpr float kOpposite = -0.999999F;
  if (axis.x < kOpposite) return {0, 1, 0, 0};
  const Vec3 cross_product{0, -axis.z, axis.y};
  const float w = 1 + axis.x;
  const float factor = 1 / std::sqrt(w * w + dot(cross_product, cross_product));
  return {0, cross_product.y * factor, cross_product.z * factor, w * factor};
}

FixedFrame fixedFrame(std::int32_t node, const Pose& node_from_frame) {
  const Quat& turn = node_from_frame.rotation;
  return {.node = node,
          .x_axis = rotate(turn, {1, 0, 0}),
          .y_axis = rotate(turn, {0, 1, 0}),
          .z_axis = rotate(turn, {0, 0, 1}),
          .origin = node_from_frame.translation};
}

/// The node that a link is fixed to, used while walking the tree.
struct Attached {
  std::int32_t node = -1;
  Pose node_from_link;
};

/// Walks the links of a robot once and collects the nodes.
class Folding {
 public:
  Folding(const Robot& robot, MotionModel& model) : robot_(robot), model_(model) {
    std::vector<LinkFrame> at_start(robot.links().begin(), robot.links().end());
    links_at_start_.resize(at_start.size());
    forwardKinematics(at_start, {}, robot.startPositions(), links_at_start_);
  }

  /// Returns for each link the node that moves it.
  Result<std::vector<Attached>> fold() {
    const std::span<const LinkFrame> links = robot_.links();
    attached_.resize(links.size());
    attached_[0] = {-1, links_at_start_[0]};
    for (std::size_t n = 1; n < links.size(); ++n) {
      const LinkFrame& link = links[n];
      const auto parent = static_cast<std::size_t>(link.parent);
      const std::optional<std::uint32_t> variable = variableOf(link);
      if (!variable) {
        const Pose parent_from_link = inverse(links_at_start_[parent]) * links_at_start_[n];
        attached_[n] = {attached_[parent].node,
                        attached_[parent].node_from_link * parent_from_link};
        continue;
      }
      if (positionCount(link.type) != 1) {
        return fail(ErrorCode::kUnsupported, "joint " + std::string(robot_.jointName(n)),
                    "is planar or floating, and an action or an episode moves it; only revolute, "
                    "continuous and prismatic joints can be moved in a simulation");
      }
      addNode(n, *variable);
    }
    return attached_;
  }

 private:
  std::optional<std::uint32_t> variableOf(const LinkFrame& link) const {
    if (link.position < 0) return std::nullopt;
    const auto first = static_cast<std::uint32_t>(link.position);
    for (std::uint32_t v = 0; v < model_.variables.size(); ++v) {
      const std::uint32_t position = model_.variables[v].position;
      if (position >= first && position < first + positionCount(link.type)) return v;
    }
    return std::nullopt;
  }

  void addNode(std::size_t n, std::uint32_t variable) {
    const LinkFrame& link = robot_.links()[n];
    const Attached& parent = attached_[static_cast<std::size_t>(link.parent)];
    const Pose joint_from_node{{}, turnXTo(link.axis)};
    const Pose parent_from_node = parent.node_from_link * link.parent_from_joint * joint_from_node;
    model_.nodes.push_back(
        {.parent = parent.node,
         .variable = variable,
         .motion = link.type == JointType::kPrismatic ? NodeMotion::kSlides : NodeMotion::kTurns,
         .multiplier = link.multiplier,
         .offset = link.offset,
         .x_axis = rotate(parent_from_node.rotation, {1, 0, 0}),
         .y_axis = rotate(parent_from_node.rotation, {0, 1, 0}),
         .z_axis = rotate(parent_from_node.rotation, {0, 0, 1}),
         .origin = parent_from_node.translation});
    attached_[n] = {static_cast<std::int32_t>(model_.nodes.size()) - 1, inverse(joint_from_node)};
  }

  const Robot& robot_;
  MotionModel& model_;
  /// root_from_link with every joint at its start position.
  std::vector<Pose> links_at_start_;
  std::vector<Attached> attached_;
};

void addVariables(const Robot& robot, std::span<const std::uint32_t> also_variable,
                  MotionModel& model) {
  for (const ControlledJoint& joint : robot.controlledJoints()) {
    const auto index = static_cast<std::uint32_t>(model.variables.size());
    model.controlled.push_back(index);
    model.variables.push_back({.position = joint.position,
                               .lower = joint.lower,
                               .upper = joint.upper,
                               .step = joint.step,
                               .action = static_cast<std::int32_t>(index),
                               .wraps = isPeriodic(robot, joint.position)});
  }
  for (const std::uint32_t position : also_variable) {
    const auto known = [&](const MotionVariable& v) { return v.position == position; };
    if (std::any_of(model.variables.begin(), model.variables.end(), known)) continue;
    const PositionLimits& limits = robot.limits()[position];
    model.variables.push_back({.position = position,
                               .lower = limits.lower,
                               .upper = limits.upper,
                               .wraps = isPeriodic(robot, position)});
  }
  // A recipe may limit a continuous joint; without limits, wrapping keeps the angle in range.
  for (MotionVariable& variable : model.variables) {
    constexpr float kUnlimited = std::numeric_limits<float>::max();
    if (variable.lower > -kUnlimited || variable.upper < kUnlimited) variable.wraps = false;
  }
}

/// A sphere and its place in the robot's own order.
struct PlacedSphere {
  BodySphere sphere;
  std::uint32_t place = 0;
};

float alongAxis(const PlacedSphere& placed, int axis) {
  const Vec3& center = placed.sphere.center;
  return axis == 0 ? center.x : (axis == 1 ? center.y : center.z);
}

/// The axis along which centers are farthest apart.
int longestAxis(std::span<const PlacedSphere> spheres) {
  int longest = 0;
  float most = -1;
  for (int axis = 0; axis < 3; ++axis) {
    const auto along = [axis](const PlacedSphere& placed) { return alongAxis(placed, axis); };
    const auto [low, high] = std::ranges::minmax_element(spheres, {}, along);
    const float length = along(*high) - along(*low);
    if (length <= most) continue;
    most = length;
    longest = axis;
  }
  return longest;
}

/// Orders spheres of one node, the first of which will be sphere number `first` of its radius, so
/// that those in the same group of eight are close together: maps and slices answer for eight at
/// once, and succeed more often for compact groups. Splits the spheres recursively, as a k-d tree
/// does, at the borders of groups.
void sortByEights(std::span<PlacedSphere> spheres, std::size_t first) {
  const std::size_t border = (first + spheres.size() / 2 + kLanes / 2) / kLanes * kLanes;
  const std::size_t last_border = (first + spheres.size() - 1) / kLanes * kLanes;
  const std::size_t first_border = (first + kLanes) / kLanes * kLanes;
  if (spheres.empty() || first_border > last_border) {
    std::ranges::sort(spheres, {}, &PlacedSphere::place);
    return;
  }
  const std::size_t middle = std::clamp(border, first_border, last_border) - first;
  const int axis = longestAxis(spheres);
  std::ranges::nth_element(spheres, spheres.begin() + static_cast<std::ptrdiff_t>(middle), {},
                           [axis](const PlacedSphere& placed) {
                             return std::pair(alongAxis(placed, axis), placed.place);
                           });
  sortByEights(spheres.first(middle), first);
  sortByEights(spheres.subspan(middle), first + middle);
}

/// The robot's spheres of one radius, node by node.
std::vector<PlacedSphere> spheresOfRadius(const Robot& robot, const std::vector<Attached>& links,
                                          std::uint32_t radius) {
  std::vector<PlacedSphere> spheres;
  std::uint32_t place = 0;
  for (const SphereGroup& group : robot.groups()) {
    const Attached& link = links[group.link];
    for (const SetSphere& sphere : group.spheres) {
      ++place;
      if (sphere.radius_index != radius) continue;
      spheres.push_back({{link.node, link.node_from_link * sphere.center}, place});
    }
  }
  std::ranges::sort(spheres, {}, [](const PlacedSphere& placed) {
    return std::pair(placed.sphere.node, placed.place);
  });
  for (std::size_t first = 0; first < spheres.size();) {
    const std::int32_t node = spheres[first].sphere.node;
    std::size_t end = first;
    while (end < spheres.size() && spheres[end].sphere.node == node) ++end;
    sortByEights(std::span(spheres).subspan(first, end - first), first);
    first = end;
  }
  return spheres;
}

void addSpheres(const Robot& robot, const std::vector<Attached>& links, MotionModel& model) {
  const std::span<const float> radii = robot.radii();
  // Pairs of place in the robot's own order and index into the model's spheres.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> places;
  for (std::uint32_t r = 0; r < radii.size(); ++r) {
    const std::vector<PlacedSphere> spheres = spheresOfRadius(robot, links, r);
    if (spheres.empty()) continue;
    const auto first = static_cast<std::uint32_t>(model.spheres.size());
    const auto count = static_cast<std::uint32_t>(spheres.size());
    for (const PlacedSphere& placed : spheres) {
      places.emplace_back(placed.place, static_cast<std::uint32_t>(model.spheres.size()));
      model.spheres.push_back(placed.sphere);
    }
    model.ranges.push_back({r, radii[r], first, count});
    model.spheres.resize(first + paddedToLanes(count), model.spheres.back());
  }
  std::ranges::sort(places);
  for (const auto& [place, sphere] : places) model.spheres_by_link.push_back(sphere);
}

}  // namespace

bool isPeriodic(const Robot& robot, std::uint32_t position) {
  bool is_continuous = false;
  for (const LinkFrame& link : robot.links()) {
    if (link.position != static_cast<std::int32_t>(position)) continue;
    const bool turns = link.type == JointType::kContinuous || link.type == JointType::kRevolute;
    if (!turns || link.multiplier != std::round(link.multiplier)) return false;
    is_continuous = is_continuous || link.type == JointType::kContinuous;
  }
  return is_continuous;
}

Result<MotionModel> makeMotionModel(const Robot& robot,
                                    std::span<const std::uint32_t> also_variable) {
  const std::string where = "robot " + std::string(robot.name());
  if (!robot.endEffector() || !robot.base()) {
    return fail(ErrorCode::kInvalidInput, where,
                "has no end effector or no base, which a simulation needs; bake it with a recipe "
                "(galactic-bake --print-recipe)");
  }
  MotionModel model;
  model.base = *robot.base();
  model.grasp_radius = robot.endEffector()->grasp_radius;
  addVariables(robot, also_variable, model);
  ASSIGN_OR_RETURN(const std::vector<Attached> links, Folding(robot, model).fold());

  model.links.reserve(links.size());
  for (const Attached& link : links) {
    model.links.push_back(fixedFrame(link.node, link.node_from_link));
  }
  const Attached& hand = links[robot.endEffector()->link];
  model.grip =
      fixedFrame(hand.node, hand.node_from_link * Pose{robot.endEffector()->grasp_point, {}});
  addSpheres(robot, links, model);
  if (model.ranges.empty()) {
    return fail(ErrorCode::kInvalidInput, where,
                "has no collision spheres, so nothing would stop it; bake it with its geometry or "
                "with --spheres");
  }
  return model;
}

}  // namespace galactic::simulation
