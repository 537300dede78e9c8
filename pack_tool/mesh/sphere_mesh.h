#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "galactic/pose.h"

namespace galactic::pack_tool {

/// The unit sphere: an icosahedron, each face cut in four a few times; after two cuts 320 triangles
/// over 162 points.
/// Points are unit vectors, so they are the normals too.
struct SphereMesh {
  std::vector<Vec3> points;
  /// Three per triangle, counter-clockwise seen from outside.
  std::vector<std::uint32_t> corners;
};
[[nodiscard]] SphereMesh makeSphereMesh(int cuts = 2);

}  // namespace galactic::pack_tool
