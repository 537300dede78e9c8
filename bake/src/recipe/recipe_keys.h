#pragma once
#include <numbers>
#include <string_view>

#include "galactic/bake/robot_recipe.h"
#include "toml/recipe_table.h"

namespace galactic::bake {

// These functions are the only description of the keys of a robot recipe. The code that reads
// recipes and the code that explains them (--print-recipe) are visitors of these functions, so that
// neither has keys of its own.

/// A key of a table: its name, its meaning and, for the recipe that explains every key, an example.
/// Without an example that recipe shows the default, which is the value of the field.
struct RecipeKey {
  std::string_view name;
  std::string_view help{};
  /// In TOML.
  std::string_view example{};
  bool is_required = false;
  /// Another key before it excludes this one, so that the explained recipe shows it as a comment.
  bool is_alternative = false;
};

/// A table, or a list of tables: its key and its purpose.
struct RecipeSection {
  std::string_view name;
  std::string_view help;
  /// For tables whose keys are names of links or joints: an example of an entry, or of a name.
  std::string_view example{};
  bool is_required = false;
};

inline constexpr NumberRange kCoordinate{-10, 10, "m"};
inline constexpr NumberRange kSphereRadius{0.001, 2, "m"};
inline constexpr NumberRange kTolerance{0.001, 1, "m"};
inline constexpr NumberRange kHeight{0, 10, "m"};
inline constexpr NumberRange kSphereCount{1, 10'000, ""};
inline constexpr NumberRange kJointPosition{-1e6, 1e6, ""};
/// The largest numbers that packs can hold.
inline constexpr NumberRange kMimicNumber{-1000, 1000, ""};

template <class V>
void visitKeys(RecipeEndEffector& effector, V& v) {
  v.name({"link", "", "gripper_link"}, effector.link);
  v.point({"grasp_point", "in the link's frame", "[0.03, 0.0, 0.0]"}, effector.grasp_point);
  v.number({"grasp_radius"}, effector.grasp_radius, kSphereRadius);
}

template <class V>
void visitKeys(RecipeCamera& camera, V& v) {
  v.name({"link", "", "head_pan_link"}, camera.link);
  v.mount({"position", "in the link's frame", "[0.2, 0.0, 0.2]"},
          {"rpy_degrees", "roll, pitch (down is positive), yaw", "[0, 20, 0]"},
          camera.link_from_camera);
  v.degrees({.name = "vertical_fov_degrees", .example = "60", .is_required = true},
            camera.vertical_fov, {1, 170, "degrees"});
}

template <class V>
void visitKeys(RecipeLaser& laser, V& v) {
  v.name({"link", "", "laser_link"}, laser.link);
  v.mount({"position", "in the link's frame", "[0.0, 0.0, 0.0]"},
          {"rpy_degrees", "roll, pitch, yaw", "[0, 0, 0]"}, laser.link_from_laser);
  v.degrees({.name = "fov_degrees", .example = "220", .is_required = true}, laser.field_of_view,
            {0, 360, "degrees"});
  v.number({"range", "farthest distance", "25.0", true}, laser.range, {0.1, 1000, "m"});
  v.number({"min_range", "nearest distance", "0.05"}, laser.least_range, {0, 1000, "m"});
  v.number({"noise", "standard deviation of a distance", "0.02"}, laser.noise, {0, 10, "m"});
}

template <class V>
void visitKeys(RecipeBase& base, V& v) {
  v.footprint({"footprint_radius", "circle around the root's origin, or:", "0.3"},
              {.name = "footprint_rectangle",
               .help = "min x, min y, max x, max y",
               .example = "[-0.3, -0.25, 0.3, 0.25]",
               .is_alternative = true},
              base.footprint);
  v.number({"forward_step", "farthest drive of one action"}, base.forward_step, {0.001, 1, "m"});
  v.degrees({"turn_step_degrees", "farthest turn of one action", "5.0"}, base.turn_step,
            {0.1, 180, "degrees"});
  v.number({"sideways_step", "the same to the side; 0: it drives ahead only"}, base.sideways_step,
           {0, 1, "m"});
  v.number({"root_height", "height of the root's origin above the ground"}, base.root_height,
           {-2, 2, "m"});
}

template <class V>
void visitKeys(RecipeJoint& joint, V& v) {
  v.name({"name", "", "shoulder_pan_joint"}, joint.joint);
  v.number({"step", "farthest move of one action", "0.196", true}, joint.step,
           {1e-4, 3.2, "(radians or meters)"});
  v.number({"min", "narrower limits than the robot's; default: the robot's", "-1.5"}, joint.min,
           kJointPosition);
  v.number({"max", "", "1.5"}, joint.max, kJointPosition);
}

template <class V>
void visitKeys(RecipeMimic& mimic, V& v) {
  v.name({"joint", "the joint that it follows", "torso_lift_joint"}, mimic.leader);
  v.number({"multiplier", "of the followed joint's position"}, mimic.multiplier, kMimicNumber);
  v.number({"offset", "added to it; radians or meters"}, mimic.offset, kMimicNumber);
}

template <class V>
void visitKeys(RecipeLinkSpheres& spheres, V& v) {
  v.number({"eps", "as above, of this link", "0.030"}, spheres.eps, kTolerance);
  v.number({"tau", "", "0.050"}, spheres.tau, kTolerance);
  v.number({"clip_height", "", "0.0"}, spheres.clip_height, kHeight);
  v.count({"max_spheres", "", "20"}, spheres.max_spheres, kSphereCount);
  v.flag({.name = "skip", .help = "no spheres", .is_alternative = true}, spheres.skip);
  v.flag({.name = "merge_with_parent",
          .help = "one set of spheres for it and its parent",
          .is_alternative = true},
         spheres.merge_with_parent);
  v.spheres({.name = "spheres",
             .help = "taken as they are: x, y, z, radius in the link's frame",
             .example = "[[0.0, 0.0, 0.0, 0.05]]",
             .is_alternative = true},
            spheres.spheres);
}

template <class V>
void visitKeys(RecipeSpheres& spheres, V& v) {
  v.number({"eps", "widest gap between surface and spheres"}, spheres.eps, kTolerance);
  v.number({"tau", "farthest protrusion of a sphere"}, spheres.tau, kTolerance);
  v.number({"max_gap", "without max_spheres: no gap is wider, if eps allows"}, spheres.max_gap,
           kTolerance);
  v.count({.name = "max_spheres",
           .help = "of the whole robot, instead of max_gap",
           .example = "100",
           .is_alternative = true},
          spheres.max_spheres, kSphereCount);
  v.number({"clip_height", "lowest height above the ground that matters"}, spheres.clip_height,
           kHeight);
  v.links({"links",
           "A link that differs, by its name. One of: other tolerances, skip, merge_with_parent, "
           "spheres.",
           "torso_lift_link"},
          spheres.links);
}

template <class V>
void visitKeys(RobotRecipe& recipe, V& v) {
  v.text({"name", "", "fetch"}, recipe.name);
  v.table({.name = "end_effector",
           .help = "What grasps: a sphere at a point of a link.",
           .is_required = true},
          recipe.end_effector);
  v.table({"camera",
           "The camera; without this table the robot has none. It looks along its own X axis, its "
           "Z axis is up in the image; a camera on an optical frame (Z forward, Y down) has "
           "rpy_degrees = [90, -90, 0]."},
          recipe.camera);
  v.table({"laser",
           "The planar laser scanner; without this table the robot has none. It scans the plane of "
           "its X and Y axes, and its X axis is the middle of its field of view. No joint that "
           "moves may carry it."},
          recipe.laser);
  v.table({.name = "base",
           .help = "The base: the root link of the robot, which drives and turns on the ground.",
           .is_required = true},
          recipe.base);
  v.joints({"joints",
            "The joints that actions move, in the order of the actions: radians, or meters where "
            "prismatic."},
           recipe.joints);
  v.limits({"limits",
            "Limits that replace the robot's or stand in for missing ones: lower, upper; of any "
            "revolute or prismatic joint. Without both, a revolute joint has -pi to pi and a "
            "prismatic one -1 to 1 m, with a warning.",
            "torso_lift_joint = [0.0, 0.38]"},
           recipe.limits);
  v.mimics(
      {"mimic",
       "A joint that follows another, by its name, as with <mimic> in a URDF: one action moves "
       "both. For the stages of a telescope, or fingers.",
       "bellows_joint"},
      recipe.mimics);
  v.positions(
      {"start_pose",
       "Where joints start, controlled or not; default where an MJCF's keyframe home has them, "
       "else 0, or the limit nearest to it.",
       "torso_lift_joint = 0.2"},
      recipe.start_pose);
  v.table({"spheres", "The collision spheres."}, recipe.spheres);
  v.pairs({"self_collision", "Pairs of links that may touch.",
           "[[\"torso_lift_link\", \"shoulder_pan_link\"]]"},
          "ignore", recipe.ignored_pairs);
}

}  // namespace galactic::bake
