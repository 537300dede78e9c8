#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "galactic/bake/source_asset.h"
#include "galactic/bake/source_robot.h"
#include "galactic/error.h"

namespace galactic::bake {

/// The name of a link or joint, and its place in the recipe ("fetch.toml:12"), for messages.
struct RecipeName {
  std::string name;
  std::string where;
};

/// The gripper: a sphere at a point of a link.
struct RecipeEndEffector {
  RecipeName link;
  /// In the link's frame (Y up, X forward), meters.
  std::array<double, 3> grasp_point{};
  /// Meters.
  double grasp_radius = 0.015;
};

struct RecipeCamera {
  RecipeName link;
  /// Rigid. The camera looks along +X of its own frame; +Y is up in the image.
  Affine link_from_camera{};
  /// Radians, between the lower and the upper edge of the image.
  double vertical_fov = 0;
};

/// A planar laser scanner.
struct RecipeLaser {
  RecipeName link;
  /// Rigid. The laser scans the XZ plane of its own frame; +X is the middle of its field of view.
  Affine link_from_laser{};
  /// Radians.
  double field_of_view = 0;
  /// Meters.
  double least_range = 0;
  double range = 0;
  /// Standard deviation of a distance, meters.
  double noise = 0;
};

/// The ground that the base covers, in the root link's frame; meters.
struct FootprintCircle {
  double radius = 0;
};
struct FootprintRectangle {
  double min_x = 0;
  double max_x = 0;
  double min_z = 0;
  double max_z = 0;
};

struct RecipeBase {
  std::variant<FootprintCircle, FootprintRectangle> footprint;
  /// Longest drive of one action, meters, and largest turn, radians.
  double forward_step = 0.1;
  double turn_step = 0.0873;
  /// Longest sideways drive of one action, meters; 0: the base does not drive sideways.
  double sideways_step = 0;
  /// Height of the root link's origin above the ground, meters.
  double root_height = 0;
};

/// A joint that an action moves.
struct RecipeJoint {
  RecipeName joint;
  /// Largest move of one action, radians or meters.
  double step = 0;
  /// Limits narrower than those of the robot file.
  std::optional<double> min;
  std::optional<double> max;
};

/// Limits that replace those of the robot file, or that the file lacks; radians or meters.
struct RecipeLimits {
  RecipeName joint;
  JointLimits limits;
};

/// A joint that follows another, as with <mimic> in a URDF.
struct RecipeMimic {
  RecipeName joint;
  /// position of `joint` = multiplier * position of `leader` + offset; radians or meters.
  RecipeName leader;
  double multiplier = 1;
  double offset = 0;
};

struct RecipeStart {
  RecipeName joint;
  /// Radians or meters.
  double position = 0;
};

/// How one link's spheres differ from the rest.
struct RecipeLinkSpheres {
  RecipeName link;
  /// Meters.
  std::optional<double> eps;
  std::optional<double> tau;
  std::optional<double> clip_height;
  std::optional<std::uint32_t> max_spheres;
  /// Whether the link gets no spheres at all.
  bool skip = false;
  /// Whether the link counts as a part of its parent: one set of spheres covers both.
  bool merge_with_parent = false;
  /// Spheres that are used as they are, in place of fitted ones; link frame (Y up, X forward).
  std::vector<HandSphere> spheres;
};

struct RecipeSpheres {
  /// Meters.
  double eps = 0.020;
  double tau = 0.040;
  /// Most spheres of the whole robot; none: as many as `max_gap` needs.
  std::optional<std::uint32_t> max_spheres;
  /// Without max_spheres, no gap between surface and spheres is wider than this, if the tolerances
  /// allow it; meters.
  double max_gap = 0.050;
  /// In the start pose, surfaces below this height above the ground need not be covered, and no
  /// sphere reaches below it; meters.
  double clip_height = 0.020;
  /// By link name.
  std::vector<RecipeLinkSpheres> links;
};

/// What a robot file (URDF, MJCF) does not specify. Every frame is Y up and X forward; SI units.
struct RobotRecipe {
  std::string name;
  /// The file that the recipe was read from, for messages and provenance.
  std::string source;
  RecipeEndEffector end_effector;
  std::optional<RecipeCamera> camera;
  std::optional<RecipeLaser> laser;
  RecipeBase base;
  /// In the order of the actions.
  std::vector<RecipeJoint> joints;
  /// Limits of revolute and prismatic joints, by joint name.
  std::vector<RecipeLimits> limits;
  /// Joints that follow others, by name, besides those in the robot file.
  std::vector<RecipeMimic> mimics;
  /// Start positions of joints, by name. Other joints start at the rest position in the robot file
  /// or, without one, at 0 or the limit nearest to 0.
  std::vector<RecipeStart> start_pose;
  RecipeSpheres spheres;
  /// Links that may touch.
  std::vector<std::pair<RecipeName, RecipeName>> ignored_pairs;
};

/// Reads a recipe in TOML, as documented by describeRobotRecipe(). Positions and rotations in the
/// text are in the frame of the robot file (Z up) and are converted here, and so are degrees to
/// radians. Strict: fails with kIo (missing file) or kInvalidInput, naming file and line, on broken
/// TOML, unknown keys (naming the nearest known key), missing keys, wrong types, values out of
/// range and contradictions.
[[nodiscard]] Result<RobotRecipe> readRobotRecipe(const std::filesystem::path& path);

/// A complete recipe with every key explained, for --print-recipe; readRobotRecipe() can read it.
[[nodiscard]] std::string describeRobotRecipe();

/// A recipe for `robot`, which must have at least one link. End effector, camera, base, joints and
/// start pose are guessed from names, tree and shapes, with comments that say so. readRobotRecipe()
/// can read the draft, and it fits the robot. Deterministic.
[[nodiscard]] std::string draftRobotRecipe(const SourceRobot& robot);

/// The limits of a link's joint: those in the recipe, if any, otherwise those in the robot file.
/// `recipe` may be null.
[[nodiscard]] std::optional<JointLimits> jointLimits(const SourceLink& link,
                                                     const RobotRecipe* recipe);

/// Makes the joints of `robot` follow others as the recipe says, replacing what its file says about
/// them. Fails with kInvalidInput if a joint does not exist or does not have exactly one position,
/// or if joints follow each other in a circle.
[[nodiscard]] Result<void> coupleJoints(const RobotRecipe& recipe, SourceRobot& robot);

/// Checks that the recipe fits the robot: links and joints exist (errors name the nearest names),
/// controlled joints can move and mimic nothing, ranges and start positions lie within limits, and
/// the root is not merged with a parent. Fails with kInvalidInput.
[[nodiscard]] Result<void> checkRecipe(const RobotRecipe& recipe, const SourceRobot& robot);

}  // namespace galactic::bake
