#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "galactic/vec3.h"

namespace galactic::pack_tool {

/// The unit sphere as 320 triangles over 162 points: an icosahedron, each face cut in four twice.
/// Points are unit vectors, so they are the normals too.
struct SphereMesh {
  std::vector<Vec3> points;
  /// Three per triangle, counter-clockwise seen from outside.
  std::vector<std::uint32_t> corners;
};
[[nodiscard]] SphereMesh makeSphereMesh();

}  // namespace galactic::pack_tool
