#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "galactic/bake/source_asset.h"
#include "galactic/kinematics.h"

namespace galactic::bake {

/// Primitive shapes, in their own frame; meters. A cylinder's axis is Y.
struct BoxShape {
  std::array<double, 3> size;
};
struct CylinderShape {
  double radius;
  double length;
};
struct SphereShape {
  double radius;
};
struct MeshShape {
  /// Index into SourceRobot::meshes.
  std::uint32_t mesh;
};

/// One visual or collision element of a link.
struct LinkShape {
  std::variant<BoxShape, CylinderShape, SphereShape, MeshShape> geometry;
  /// Includes the mesh's scale and, for an ellipsoid, the scaling that makes it from a sphere.
  Affine link_from_shape{};
  /// Linear RGBA, if the robot file names a color.
  std::optional<std::array<float, 4>> color;
  /// Whether the color overrides materials in the mesh file (MJCF). Otherwise (URDF) it is used
  /// only if the mesh file has none.
  bool hides_looks = false;
  /// With hides_looks: an image that is drawn on a mesh with texture coordinates, in place of those
  /// of its file. Relative to the robot file's folder; empty: none.
  std::string texture{};
};

/// Radians or meters, lower <= upper.
struct JointLimits {
  double lower = 0;
  double upper = 0;
};

/// position = multiplier * position of `link`'s joint + offset.
struct Mimic {
  /// Index of the link whose joint is followed, which is not a mimic itself.
  std::uint32_t link = 0;
  double multiplier = 1;
  double offset = 0;
};

/// One link and the joint to its parent, in the runtime's frame: Y up, X forward.
struct SourceLink {
  std::string name;
  /// Index of the parent link, always smaller than its own; -1 for the root.
  int parent = -1;
  std::string joint_name;
  JointType joint_type = JointType::kFixed;
  /// Pose of the joint in the parent link's frame; rigid.
  Affine parent_from_joint{};
  /// Unit axis in the joint frame.
  std::array<double, 3> axis{1, 0, 0};
  /// None: unlimited.
  std::optional<JointLimits> limits;
  /// Whether the file gives no limits although the joint needs some, so that `limits` is a guess.
  bool limits_are_assumed = false;
  std::optional<Mimic> mimic;
  /// Rest position of the joint in the file (MJCF's keyframe "home"); radians or meters.
  std::optional<double> rest;
  std::vector<LinkShape> collisions;
  std::vector<LinkShape> visuals;
  /// Whether the file has visuals but none could be read: the collision shapes are drawn instead.
  bool visuals_are_lost = false;
  /// Whether the link stands for a camera in the file (MJCF), which looks along the link's X with Z
  /// up.
  bool is_camera = false;
};

/// What the robot importer passes to the baker: independent of the format, every frame Y up and X
/// forward, meters.
struct SourceRobot {
  std::string name;
  /// Root first, parents before children; children in the order of the file's joints.
  std::vector<SourceLink> links;
  /// Each mesh file once, and each mesh that stands in the robot's own file. The first of the
  /// `read.files` of each is the file that has it.
  std::vector<SourceAsset> meshes;
  /// Links that the file allows to touch, by index.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> may_touch;
  /// The robot file, the files that it includes, every mesh and texture, including those that do
  /// not load, and every package.xml that decided where meshes are; relative to the robot file's
  /// folder. Unsettled if a mesh does not load, because another file may be missing, or if a
  /// package was searched for in many folders.
  ReadFiles read;
  /// One sentence each.
  std::vector<std::string> warnings;
  /// References to meshes that were not found, as in the file.
  std::vector<std::string> missing;
  /// One sentence for each mesh that was found but does not load.
  std::vector<std::string> unreadable;
  /// Where each mesh was found, one line each, for -v.
  std::vector<std::string> resolutions;
};

/// A sphere placed by hand or by another tool, of any radius. Meters.
struct HandSphere {
  std::array<double, 3> center{};
  double radius = 0;

  friend bool operator==(const HandSphere&, const HandSphere&) = default;
};

/// The spheres of one link, in the link's frame: Y up, X forward.
struct LinkSpheres {
  std::string link;
  std::vector<HandSphere> spheres;

  friend bool operator==(const LinkSpheres&, const LinkSpheres&) = default;
};

struct HandSpheres {
  /// In the order of the file; links without spheres are left out.
  std::vector<LinkSpheres> links;
  /// One sentence each: collision elements that are no spheres.
  std::vector<std::string> warnings;

  friend bool operator==(const HandSpheres&, const HandSpheres&) = default;
};

}  // namespace galactic::bake
