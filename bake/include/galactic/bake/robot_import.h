#pragma once
#include <array>
#include <chrono>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "galactic/bake/mesh_import.h"
#include "galactic/bake/source_robot.h"
#include "galactic/error.h"

namespace galactic::bake {

/// A robot's file of more bytes is refused.
inline constexpr std::uintmax_t kMaxRobotFileBytes = std::uintmax_t{64} << 20U;

/// The folders of the environment variable ROS_PACKAGE_PATH, separated by colons.
[[nodiscard]] std::vector<std::filesystem::path> rosPackagePath();

/// How to read a robot's file.
struct RobotImportOptions {
  /// Folders of packages by name (--package NAME=DIR); these come first.
  std::map<std::string, std::filesystem::path> packages;
  /// Folders in which packages are looked for, in this order (ROS_PACKAGE_PATH).
  std::vector<std::filesystem::path> search_roots;
  /// A link that lost all its geometry is a warning instead of an error.
  bool allow_missing = false;
  /// Whether absolute paths, and relative ones that lead upwards, may lead anywhere: without it,
  /// into packages, and below the folder above the robot file's.
  bool allow_outside = false;
  /// Up axis of the file: kZ, or kY for furniture made for simulators that are Y up.
  UpAxis up = UpAxis::kZ;
  /// The XML is read in a process of its own, which is stopped after this long.
  std::chrono::seconds time_limit{60};
};

/// Reads a robot from the text of a URDF or an MJCF (MuJoCo's XML), with its meshes. They are told
/// apart by the outermost element, <robot> or <mujoco>.
///
/// Frames: everything is converted once, (x, y, z) to (x, z, -y), so that link, joint and shape
/// frames are Y up and X forward; a primitive's size and a mesh's points likewise. The points of a
/// mesh file count as they stand in the file, after its node transforms and its unit: the up axis
/// that COLLADA or glTF state is not applied, as in RViz and MoveIt (ros-visualization/rviz#1045,
/// moveit/geometric_shapes#52), for which robots' meshes are made. Scales may be negative: then
/// link_from_shape mirrors.
///
/// Meshes: package://, model://, file://, absolute paths and paths relative to the robot's file (of
/// an MJCF in its `meshdir`). A package is looked for in options.packages, then in
/// options.search_roots, then from the file's folder upwards; at last its path inside the package
/// is tried from the file's folder upwards, with a warning. SourceRobot::resolutions names where
/// each was found. Each file is loaded once; in its SourceAsset, names of files and textures are
/// relative to the folder of the robot's file.
///
/// What is missing is loud: a mesh that is not found or does not load is a warning while its link
/// keeps other geometry, and an error when the link lost all (see allow_missing). Where all visuals
/// are lost, the warning says that the collision elements are drawn instead, if there are any
/// (SourceLink::visuals_are_lost). For links with visuals but without collision elements a warning
/// says that the visuals stand in for them.
///
/// Colors are taken as sRGB and converted to linear; material textures of a URDF are not used
/// (warning), those of an MJCF are where its mesh has texture coordinates. Joints: continuous
/// joints have no limits. Of revolute and prismatic ones of a URDF lower or upper is 0 when it
/// alone is absent; without both, -pi to pi and -1 to 1 m are assumed
/// (SourceLink::limits_are_assumed). Planar axes are the plane's normal. Chains of mimics are
/// resolved, so that Mimic::link never mimics itself. Joints of a URDF may hang from a link "world"
/// that nothing declares: it is added, with a warning.
///
/// An MJCF's bodies are links in the bodies' own frames. A body with several joints, or with a
/// hinge beside its origin, has links without shape before it. A hinge without a range is
/// continuous. What else is read of MJCF and what is not: docs/objects_and_robots.md.
///
/// Fails with kIo (missing or unreadable file), kUnsupported (xacro, an up axis other than Y or Z,
/// elements of MJCF that make bodies) or kInvalidInput: broken XML, no or several roots, loops, two
/// parents, duplicate or unknown names, numbers that are not finite or beyond kMaxCoordinate,
/// limits with lower > upper, axes without direction, mimics in a circle, geometry without positive
/// size, lost geometry. Deterministic; thread-safe; prints nothing.
[[nodiscard]] Result<SourceRobot> importRobot(const std::filesystem::path& path,
                                              const RobotImportOptions& options = {});

/// What a link weighs as the file states it, which may be impossible: nothing is checked. In the
/// file's frame (Z up, but for furniture), unlike what importRobot returns.
struct LinkInertial {
  /// Of the link.
  std::string link;
  /// Kilograms.
  double mass = 0;
  /// Center of mass in the link's frame, meters.
  std::array<double, 3> center{};
  /// xx, yy, zz, xy, xz, yz about the center, along the axes of the link's frame; kg m^2.
  std::array<double, 6> moments{};
};

/// The masses of a robot, in the order of the file's links: what <inertial> elements state or, in
/// an MJCF, shapes of their density or mass are (solid; an open mesh counts as the box around it).
/// Links without are left out, and so is what missing meshes weigh. Baking needs none of it: packs
/// hold no masses. `options` as for importRobot, which fails on the same; its `up` and
/// `allow_missing` do not matter. Deterministic; thread-safe.
[[nodiscard]] Result<std::vector<LinkInertial>> readInertials(
    const std::filesystem::path& path, const RobotImportOptions& options = {});

}  // namespace galactic::bake
