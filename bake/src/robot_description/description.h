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

/// A visual or collision element as the text states it: Z up.
struct DescribedShape {
  DescribedGeometry geometry = DescribedGeometry::kBox;
  /// Box: sides. Cylinder: radius, length. Sphere: radius. Ellipsoid: half axes. Mesh: scale.
  std::array<double, 3> size{};
  /// Mesh: the reference to its file, unless it stands in the text.
  std::string mesh;
  /// Mesh that stands in the text: index into RobotDescription::meshes.
  std::optional<std::uint32_t> own_mesh;
  Affine link_from_shape{};
  bool has_color = false;
  /// sRGB and alpha.
  std::array<double, 4> color{};
  /// A texture that the material names.
  std::string texture;
  /// Whether color and texture count whatever a mesh's file says of its looks (MJCF). Else (URDF)
  /// the color counts where the file says nothing, and the texture never.
  bool hides_looks = false;
};

/// A mesh that a link's mass is spread over, where the text has no inertia for it.
struct DescribedMass {
  DescribedShape mesh;
  bool has_mass = false;
  /// Kilograms, where it has one; else its volume weighs `density` kg/m^3.
  double mass = 0;
  double density = 0;
};

struct DescribedLink {
  std::string name;
  std::vector<DescribedShape> visuals;
  std::vector<DescribedShape> collisions;
  /// What it weighs, if that was asked for: the sum of these.
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
  /// Empty: mimics nothing.
  std::string mimic;
  double multiplier = 1;
  double offset = 0;
  /// Where the file says that the robot rests.
  bool has_rest = false;
  double rest = 0;
};

/// A mesh that stands in the text itself.
struct DescribedMesh {
  std::string name;
  std::vector<std::array<double, 3>> points;
  std::vector<Triangle> triangles;
};

/// Names of two links.
struct DescribedPair {
  std::string first;
  std::string second;
};

/// A robot as its text states it, elements in the order of the text; nothing checked beyond syntax.
struct RobotDescription {
  std::string name;
  std::vector<DescribedLink> links;
  std::vector<DescribedJoint> joints;
  std::vector<DescribedMesh> meshes;
  /// Kilograms to which all masses are brought; 0: they are as stated.
  double total_mass = 0;
  /// Links that may touch.
  std::vector<DescribedPair> touching;
  /// Files that were read beside the robot's own.
  std::vector<std::string> included;
  /// Files that were looked for and are not there.
  std::vector<std::string> absent;
  /// What the reader warns of.
  std::vector<std::string> warnings;
};

/// What somebody wants to know of a robot's file.
enum class DescriptionPart { kShapesAndJoints, kMasses };

}  // namespace galactic::bake
