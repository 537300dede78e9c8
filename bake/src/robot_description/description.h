#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "galactic/bake/source_robot.h"
#include "robot_description/hand_spheres.h"

namespace galactic::bake {

enum class DescribedGeometry : std::uint32_t { kBox, kCylinder, kSphere, kMesh };

/// A visual or collision element as the text states it: URDF frame.
struct DescribedShape {
  DescribedGeometry geometry = DescribedGeometry::kBox;
  /// Box: sides. Cylinder: radius, length. Sphere: radius. Mesh: scale.
  std::array<double, 3> size{};
  /// Mesh: the reference to its file.
  std::string mesh;
  Affine link_from_shape{};
  bool has_color = false;
  /// sRGB and alpha.
  std::array<double, 4> color{};
  /// A texture that the material names.
  std::string texture;
};

struct DescribedLink {
  std::string name;
  std::vector<DescribedShape> visuals;
  std::vector<DescribedShape> collisions;
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
};

/// A URDF as its text states it, elements in the order of the text; nothing checked beyond syntax.
struct RobotDescription {
  std::string name;
  std::vector<DescribedLink> links;
  std::vector<DescribedJoint> joints;
  /// What the parser warned of.
  std::vector<std::string> warnings;
};

}  // namespace galactic::bake
