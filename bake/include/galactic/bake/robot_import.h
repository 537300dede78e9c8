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

/// A robot file with more bytes than this is refused.
inline constexpr std::uintmax_t kMaxRobotFileBytes = std::uintmax_t{64} << 20U;

/// The folders of the environment variable ROS_PACKAGE_PATH, separated by colons.
[[nodiscard]] std::vector<std::filesystem::path> rosPackagePath();

/// How to read a robot file.
struct RobotImportOptions {
  /// Folders of packages by name (--package NAME=DIR); these come first.
  std::map<std::string, std::filesystem::path> packages;
  /// Folders in which packages are searched for, in this order (ROS_PACKAGE_PATH).
  std::vector<std::filesystem::path> search_roots;
  /// Whether a link that lost all its geometry causes a warning instead of an error.
  bool allow_missing = false;
  /// Whether meshes and included files may lie anywhere. Otherwise they must lie in packages, or
  /// below the folder above the robot file's folder.
  bool allow_outside = false;
  /// Up axis of the file: kZ, or kY for furniture made for simulators that are Y up.
  UpAxis up = UpAxis::kZ;
  /// The XML is read in a process of its own, which is stopped after this time.
  std::chrono::seconds time_limit{60};
};

/// Reads a robot from a URDF or an MJCF (MuJoCo's XML), with its meshes. The formats are
/// distinguished by the outermost element, <robot> or <mujoco>.
///
/// Frames: everything is converted once, (x, y, z) to (x, z, -y), so that link, joint and shape
/// frames are Y up and X forward; sizes of primitives and points of meshes likewise. The points of
/// a mesh file are used as they are in the file, after its node transforms and its unit. The up
/// axis that COLLADA or glTF states is not applied, as in RViz and MoveIt
/// (ros-visualization/rviz#1045, moveit/geometric_shapes#52), for which robots' meshes are made.
/// Scales may be negative: link_from_shape then mirrors.
///
/// Meshes: package://, model://, file://, absolute paths and paths relative to the robot file (for
/// an MJCF, in its `meshdir`). A package is searched for in options.packages, then in
/// options.search_roots, then from the file's folder upwards. As a last resort, the path inside the
/// package, or a relative path without "..", is tried from the file's folder upwards, with a
/// warning. However it is found, a mesh must lie in a package, in one of options.search_roots, or
/// below the folder above the file's folder, unless options.allow_outside: otherwise it counts as
/// missing. SourceRobot::resolutions names where each was found. Each file is loaded once; in its
/// SourceAsset, names of files and textures are relative to the folder of the robot's file.
///
/// Missing meshes are always reported. A mesh that is not found or does not load causes a warning
/// if its link keeps other geometry, and an error if the link loses all of it (see allow_missing).
/// If all visuals are lost, the warning says that the collision elements, if any, are drawn instead
/// (SourceLink::visuals_are_lost). For a link with visuals but without collision elements, a
/// warning says that the visuals are used in their place.
///
/// Colors are interpreted as sRGB and converted to linear. Material textures of a URDF are not used
/// (warning); those of an MJCF are used if the mesh has texture coordinates. Joints: continuous
/// joints have no limits. For revolute and prismatic joints of a URDF, if only one of lower and
/// upper is absent, it is 0; without both, -pi to pi and -1 to 1 m are assumed
/// (SourceLink::limits_are_assumed). Planar axes are the plane's normal. Chains of mimics are
/// resolved, so that the joint of Mimic::link is never a mimic itself. Joints of a URDF may have a
/// parent link "world" that is not declared: it is added, with a warning.
///
/// An MJCF's bodies become links in the bodies' own frames. Before a body with several joints, or
/// with a hinge that is not at its origin, links without shape are inserted. A hinge without a
/// range is continuous. docs/objects_and_robots.md lists what else is read of MJCF and what is not.
///
/// Fails with kIo (missing or unreadable file), kUnsupported (xacro, an up axis other than Y or Z,
/// elements of MJCF that generate bodies) or kInvalidInput: broken XML, no root or several, loops,
/// two parents, duplicate or unknown names, numbers that are not finite or beyond kMaxCoordinate,
/// limits with lower > upper, axes without direction, mimics in a circle, geometry without positive
/// size, lost geometry. Deterministic; thread-safe; prints nothing.
[[nodiscard]] Result<SourceRobot> importRobot(const std::filesystem::path& path,
                                              const RobotImportOptions& options = {});

/// Mass and inertia of a link as the file states them. Nothing is checked, so they may be
/// physically impossible. In the file's frame (Z up, except for furniture), unlike the result of
/// importRobot().
struct LinkInertial {
  /// Name of the link.
  std::string link;
  /// Kilograms.
  double mass = 0;
  /// Center of mass in the link's frame, meters.
  std::array<double, 3> center{};
  /// xx, yy, zz, xy, xz, yz about the center, along the axes of the link's frame; kg m^2.
  std::array<double, 6> moments{};
};

/// The masses of a robot, in the order of the file's links: as stated in <inertial> elements or,
/// for an MJCF, as they follow from the density or mass of its shapes (solid; an open mesh counts
/// as the box around it). Links without mass are left out, and so is the mass of missing meshes.
/// Baking does not need masses, and packs have none. `options` are those of importRobot(), and so
/// are the errors; `up` and `allow_missing` are ignored. Deterministic; thread-safe.
[[nodiscard]] Result<std::vector<LinkInertial>> readInertials(
    const std::filesystem::path& path, const RobotImportOptions& options = {});

}  // namespace galactic::bake
