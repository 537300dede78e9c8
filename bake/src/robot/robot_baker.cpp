#include "galactic/bake/robot_baker.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "import/affine.h"
#include "robot/group_spheres.h"
#include "robot/robot_parts.h"
#include "sphere_set/prepared_fit.h"
#include "support/text/nearest_name.h"
#include "support/threads/stopwatch.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

std::uint32_t linkIndex(const SourceRobot& robot, const std::string& name) {
  const auto found = std::find_if(robot.links.begin(), robot.links.end(),
                                  [&](const SourceLink& link) { return link.name == name; });
  return static_cast<std::uint32_t>(found - robot.links.begin());
}

std::size_t jointLinkIndex(const SourceRobot& robot, const std::string& joint) {
  const auto found = std::find_if(robot.links.begin(), robot.links.end(),
                                  [&](const SourceLink& link) { return link.joint_name == joint; });
  return static_cast<std::size_t>(found - robot.links.begin());
}

Vec3 vectorOf(const std::array<double, 3>& v) {
  return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

Affine affineOf(const Pose& pose) {
  const Vec3 x = rotate(pose.rotation, {1, 0, 0});
  const Vec3 y = rotate(pose.rotation, {0, 1, 0});
  const Vec3 z = rotate(pose.rotation, {0, 0, 1});
  const Vec3& t = pose.translation;
  const auto d = [](float value) { return static_cast<double>(value); };
  return {d(x.x), d(y.x), d(z.x), d(t.x), d(x.y), d(y.y),
          d(z.y), d(t.y), d(x.z), d(y.z), d(z.z), d(t.z)};
}

/// joint_from_link of each link at the start positions, as findRigidGroups needs it for joints that
/// can move.
std::vector<Affine> startTransforms(const FlatKinematics& flat) {
  std::vector<Pose> parent_from_link(flat.links.size());
  std::vector<Affine> transforms;
  for (std::size_t n = 0; n < flat.links.size(); ++n) {
    // Treats the link alone, with its joint at the origin.
    LinkFrame link = flat.links[n];
    link.parent = -1;
    link.parent_from_joint = {};
    forwardKinematics({&link, 1}, {}, flat.start_positions, {&parent_from_link[n], 1});
    transforms.push_back(affineOf(parent_from_link[n]));
  }
  return transforms;
}

/// Checks that all names exist: the runtime finds links and joints by name.
Result<void> checkNames(const SourceRobot& robot, const RobotRecipe* recipe) {
  if (robot.links.empty()) {
    return fail(ErrorCode::kInvalidInput, "", "the robot has no links; give at least one");
  }
  if (robot.name.empty() && (recipe == nullptr || recipe->name.empty())) {
    return fail(ErrorCode::kInvalidInput, "",
                "the robot has no name; give <robot> one, or the recipe");
  }
  for (std::size_t n = 0; n < robot.links.size(); ++n) {
    if (robot.links[n].name.empty()) {
      return fail(ErrorCode::kInvalidInput, "",
                  fmt::format("a link has an empty name, number {} from the root on; name it", n));
    }
    if (n > 0 && robot.links[n].joint_name.empty()) {
      return fail(ErrorCode::kInvalidInput, fmt::format("link '{}'", robot.links[n].name),
                  "the joint to its parent has an empty name; name it");
    }
  }
  return {};
}

/// Checks the working set and the tolerances, even if no spheres are fitted.
Result<void> checkShapeOptions(const RobotBakeOptions& options) {
  SphereSetOptions asked;
  asked.radii = options.radii;
  if (options.eps) asked.eps = *options.eps;
  if (options.tau) asked.tau = *options.tau;
  return sphere_set::checkOptions(asked);
}

/// Refuses spheres for links that do not exist, which would be lost silently.
Result<void> checkHandSpheres(const SourceRobot& robot, const RobotBakeOptions& options) {
  if (!options.hand_spheres) return {};
  std::vector<std::string> names;
  for (const SourceLink& link : robot.links) names.push_back(link.name);
  for (const LinkSpheres& given : options.hand_spheres->links) {
    if (std::find(names.begin(), names.end(), given.link) != names.end()) continue;
    return fail(ErrorCode::kInvalidInput, "",
                fmt::format("hand-made spheres are given for the link '{}', which the robot '{}' "
                            "does not have; {}",
                            given.link, robot.name, suggestNames(given.link, names)));
  }
  return {};
}

/// Bakes a robot part by part.
class RobotBaker {
 public:
  RobotBaker(const SourceRobot& robot, const RobotRecipe* recipe, const RobotBakeOptions& options,
             unsigned threads)
      : robot_(robot), recipe_(recipe), options_(options), threads_(threads) {}

  Result<BakedRobot> bake() {
    baked_.name = recipe_ != nullptr && !recipe_->name.empty() ? recipe_->name : robot_.name;
    baked_.radii = options_.radii;
    baked_.warnings = robot_.warnings;
    for (const SourceLink& link : robot_.links) {
      baked_.link_names.push_back(link.name);
      baked_.joint_names.push_back(link.joint_name);
    }
    baked_.kinematics = flattenKinematics(robot_, recipe_);
    warnOfLimits();
    makeSurfaces();
    RETURN_IF_ERROR(makeSpheres());
    {
      const detail::Stopwatch timer(baked_.times.self_collision);
      baked_.pairs = classifyPairs(baked_, ignoredPairs());
    }
    if (recipe_ != nullptr) applyRecipe();
    return std::move(baked_);
  }

 private:
  /// Warns of limits that the robot's file lacks, or that allow no movement, unless the recipe
  /// replaces them.
  void warnOfLimits() {
    for (const SourceLink& link : robot_.links) {
      if (!link.limits || link.mimic) continue;
      const bool is_given =
          recipe_ != nullptr &&
          std::any_of(recipe_->limits.begin(), recipe_->limits.end(),
                      [&](const RecipeLimits& l) { return l.joint.name == link.joint_name; });
      if (is_given) continue;
      if (link.limits_are_assumed) {
        baked_.warnings.push_back(fmt::format(
            "joint '{}': the robot's file states no limits for it; {:.3g} to {:.3g} {} are "
            "assumed, [limits] of the recipe may state others",
            link.joint_name, link.limits->lower, link.limits->upper,
            link.joint_type == JointType::kPrismatic ? "m" : "rad"));
      } else if (link.limits->lower == link.limits->upper) {
        baked_.warnings.push_back(
            fmt::format("joint '{}': its limits are both {}, so it cannot move; [limits] of the "
                        "recipe may state others",
                        link.joint_name, link.limits->lower));
      }
    }
  }

  void makeSurfaces() {
    for (const SourceLink& link : robot_.links) {
      baked_.collision_surfaces.push_back(surfaceOfShapes(robot_, link.collisions));
      baked_.visual_surfaces.push_back(surfaceOfShapes(robot_, link.visuals));
    }
  }

  Result<void> makeSpheres() {
    const detail::Stopwatch timer(baked_.times.spheres);
    // Visual geometry stands in for missing collision geometry.
    std::vector<Surface> fitted;
    for (std::size_t n = 0; n < robot_.links.size(); ++n) {
      const bool has_collision = !baked_.collision_surfaces[n].empty();
      fitted.push_back(has_collision ? baked_.collision_surfaces[n] : baked_.visual_surfaces[n]);
    }
    const std::vector<Pose> world_from_link = startPoses(fitted);
    const auto groups = findRigidGroups(robot_, recipe_, startTransforms(baked_.kinematics));
    const SphereTask task{robot_, recipe_, options_, fitted, world_from_link, threads_};
    ASSIGN_OR_RETURN(auto made, makeGroupSpheres(groups, task, baked_.warnings));
    baked_.groups = std::move(made);
    const bool any =
        std::any_of(baked_.groups.begin(), baked_.groups.end(),
                    [](const BakedGroup& group) { return !group.spheres.spheres.empty(); });
    if (any) return {};
    return fail(ErrorCode::kInvalidInput, "",
                "no link has geometry, so the robot would be without spheres; give its meshes with "
                "`package`, or spheres in a recipe");
  }

  /// Poses of the links at the start, with the robot standing on the ground: at the recipe's
  /// height, or else with its lowest point at height 0.
  std::vector<Pose> startPoses(const std::vector<Surface>& surfaces) const {
    std::vector<Pose> poses(robot_.links.size());
    const FlatKinematics& flat = baked_.kinematics;
    Pose world_from_root;
    if (recipe_ != nullptr) {
      world_from_root.translation.y = static_cast<float>(recipe_->base.root_height);
    } else {
      forwardKinematics(flat.links, {}, flat.start_positions, poses);
      float lowest = std::numeric_limits<float>::max();
      for (std::size_t n = 0; n < poses.size(); ++n) {
        for (const Vec3& p : surfaces[n].positions) lowest = std::min(lowest, (poses[n] * p).y);
      }
      if (lowest < std::numeric_limits<float>::max()) world_from_root.translation.y = -lowest;
    }
    forwardKinematics(flat.links, world_from_root, flat.start_positions, poses);
    return poses;
  }

  std::vector<std::pair<std::uint32_t, std::uint32_t>> ignoredPairs() const {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs = robot_.may_touch;
    if (recipe_ == nullptr) return pairs;
    for (const auto& [first, second] : recipe_->ignored_pairs) {
      pairs.emplace_back(linkIndex(robot_, first.name), linkIndex(robot_, second.name));
    }
    return pairs;
  }

  void applyRecipe() {
    const RecipeEndEffector& effector = recipe_->end_effector;
    baked_.end_effector =
        EndEffector{linkIndex(robot_, effector.link.name), vectorOf(effector.grasp_point),
                    static_cast<float>(effector.grasp_radius)};
    warnOfGraspInside(*baked_.end_effector);
    if (recipe_->camera) {
      baked_.camera = RobotCamera{linkIndex(robot_, recipe_->camera->link.name),
                                  poseOf(recipe_->camera->link_from_camera),
                                  static_cast<float>(recipe_->camera->vertical_fov)};
    }
    if (recipe_->laser) baked_.laser = laserOf(*recipe_->laser);
    baked_.base = baseOf(recipe_->base);
    for (const RecipeJoint& joint : recipe_->joints) {
      baked_.controlled_joints.push_back(controlledJoint(joint));
    }
  }

  /// Warns if the grasp point is inside a sphere that moves with the hand: no object can be there.
  void warnOfGraspInside(const EndEffector& hand) {
    const FlatKinematics& flat = baked_.kinematics;
    std::vector<Pose> root_from_link(flat.links.size());
    forwardKinematics(flat.links, {}, flat.start_positions, root_from_link);
    // Each link is in exactly one group.
    const auto group = std::ranges::find_if(baked_.groups, [&](const BakedGroup& one) {
      return std::ranges::find(one.links, hand.link) != one.links.end();
    });
    const Vec3 grasp_point =
        inverse(root_from_link[group->link]) * root_from_link[hand.link] * hand.grasp_point;
    for (const SetSphere& sphere : group->spheres.spheres) {
      const Vec3 way = grasp_point - sphere.center;
      const float radius = baked_.radii[sphere.radius_index];
      if (dot(way, way) >= radius * radius) continue;
      baked_.warnings.push_back(
          fmt::format("[end_effector] grasp_point: it is {:.3f} m from the center of a sphere of "
                      "{} m that moves with link '{}', where no object can be grasped; move it "
                      "outside of the robot",
                      std::sqrt(dot(way, way)), radius, robot_.links[hand.link].name));
      return;
    }
  }

  [[nodiscard]] RobotLaser laserOf(const RecipeLaser& recipe) const {
    return {.link = linkIndex(robot_, recipe.link.name),
            .link_from_laser = poseOf(recipe.link_from_laser),
            .field_of_view = static_cast<float>(recipe.field_of_view),
            .least_range = static_cast<float>(recipe.least_range),
            .range = static_cast<float>(recipe.range),
            .noise = static_cast<float>(recipe.noise)};
  }

  static RobotBase baseOf(const RecipeBase& recipe) {
    RobotBase base;
    base.forward_step = static_cast<float>(recipe.forward_step);
    base.turn_step = static_cast<float>(recipe.turn_step);
    base.sideways_step = static_cast<float>(recipe.sideways_step);
    base.root_height = static_cast<float>(recipe.root_height);
    if (const auto* circle = std::get_if<FootprintCircle>(&recipe.footprint)) {
      const auto radius = static_cast<float>(circle->radius);
      base.footprint_radius = radius;
      base.footprint_min = {-radius, 0, -radius};
      base.footprint_max = {radius, 0, radius};
    } else {
      const auto& rectangle = std::get<FootprintRectangle>(recipe.footprint);
      base.footprint_min = {static_cast<float>(rectangle.min_x), 0,
                            static_cast<float>(rectangle.min_z)};
      base.footprint_max = {static_cast<float>(rectangle.max_x), 0,
                            static_cast<float>(rectangle.max_z)};
    }
    return base;
  }

  ControlledJoint controlledJoint(const RecipeJoint& joint) const {
    const FlatKinematics& flat = baked_.kinematics;
    const LinkFrame& link = flat.links[jointLinkIndex(robot_, joint.joint.name)];
    const auto position = static_cast<std::uint32_t>(link.position);
    const PositionLimits& limits = flat.limits[position];
    const auto inside = [&](const std::optional<double>& wanted, float otherwise) {
      return wanted ? std::clamp(static_cast<float>(*wanted), limits.lower, limits.upper)
                    : otherwise;
    };
    return {position, static_cast<float>(joint.step), inside(joint.min, limits.lower),
            inside(joint.max, limits.upper)};
  }

  const SourceRobot& robot_;
  const RobotRecipe* recipe_;
  const RobotBakeOptions& options_;
  unsigned threads_;
  BakedRobot baked_;
};

}  // namespace

Result<BakedRobot> bakeRobot(const SourceRobot& robot, const RobotRecipe* recipe,
                             const RobotBakeOptions& options, unsigned threads) {
  if (recipe != nullptr) {
    RETURN_IF_ERROR(checkRecipe(*recipe, robot));
  }
  for (const auto& checked :
       {checkNames(robot, recipe), checkShapeOptions(options), checkHandSpheres(robot, options)}) {
    if (!checked) return tl::unexpected(checked.error());
  }
  if (recipe == nullptr || recipe->mimics.empty()) {
    return RobotBaker(robot, recipe, options, threads).bake();
  }
  SourceRobot coupled = robot;
  RETURN_IF_ERROR(coupleJoints(*recipe, coupled));
  return RobotBaker(coupled, recipe, options, threads).bake();
}

}  // namespace galactic::bake
