#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "galactic/bake/robot_import.h"
#include "galactic/bake/source_robot.h"

namespace galactic::bake {

enum class DescribedGeometry : std::uint32_t { kBox, kCylinder, kSphere, kEllipsoid, kMesh };

/// A visual or collision element as in the text: Z up.
struct DescribedShape {
  DescribedGeometry geometry = DescribedGeometry::kBox;
  /// Box: sides. Cylinder: radius, length. Sphere: radius. Ellipsoid: half axes. Mesh: scale.
  std::array<double, 3> size{};
  /// For a mesh, the reference to its file, unless the mesh is in the text itself.
  std::string mesh;
  /// For a mesh that is in the text itself, its index into RobotDescription::meshes.
  std::optional<std::uint32_t> own_mesh;
  Affine link_from_shape{};
  bool has_color = false;
  /// sRGB and alpha.
  std::array<double, 4> color{};
  /// The texture that the material names.
  std::string texture;
  /// If true (MJCF), color and texture replace the looks that a mesh's file states. If false
  /// (URDF), the color counts only if the file states no looks, and the texture never does.
  bool hides_looks = false;
};

/// A mesh that gives a link its mass and inertia if the text states none.
struct DescribedMass {
  DescribedShape mesh;
  bool has_mass = false;
  /// Kilograms, if it has a mass; otherwise its volume weighs `density` kg/m^3.
  double mass = 0;
  double density = 0;
};

struct DescribedLink {
  std::string name;
  std::vector<DescribedShape> visuals;
  std::vector<DescribedShape> collisions;
  /// The link's mass is the sum of these and `masses`; empty unless masses were requested.
  std::vector<LinkInertial> inertials;
  std::vector<DescribedMass> masses;
  /// See SourceLink.
  bool is_camera = false;
};

struct DescribedJoint {
  std::string name;
  std::string parent;
  std::string child;
  JointType type = JointType::kFixed;
  Affine parent_from_joint{};
  std::array<double, 3> axis{};
  bool has_limits = false;
  double lower = 0;
  double upper = 0;
  /// Name of the joint that it mimics; empty if none.
  std::string mimic;
  double multiplier = 1;
  double offset = 0;
  /// Whether the file states the rest position of the joint.
  bool has_rest = false;
  double rest = 0;
};

/// A mesh that is in the text itself.
struct DescribedMesh {
  std::string name;
  std::vector<std::array<double, 3>> points;
  std::vector<Triangle> triangles;
};

/// The names of two links.
struct DescribedPair {
  std::string first;
  std::string second;
};

/// A robot as in its text, with elements in the order of the text; nothing beyond syntax has been
/// checked.
struct RobotDescription {
  std::string name;
  std::vector<DescribedLink> links;
  std::vector<DescribedJoint> joints;
  std::vector<DescribedMesh> meshes;
  /// Kilograms that all masses are scaled to; if 0, they stay as they are.
  double total_mass = 0;
  /// Pairs of links that may touch.
  std::vector<DescribedPair> touching;
  /// Files that were read in addition to the robot's own.
  std::vector<std::string> included;
  /// Files that were looked for but do not exist.
  std::vector<std::string> absent;
  /// Warnings of the reader.
  std::vector<std::string> warnings;
};

/// The part of a robot's file to read.
enum class DescriptionPart { kShapesAndJoints, kMasses };

}  // namespace galactic::bake
