#pragma once
#include <array>
#include <cstddef>
#include <vector>

#include "column_grid/triangle_interval.h"
#include "galactic/bake/triangle_mesh.h"

namespace galactic::test {

using Corners = std::array<bake::Point, 3>;

inline bake::Point toPoint(const Vec3& v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

/// The corners of every triangle of a mesh, in double.
inline std::vector<Corners> allCorners(const bake::TriangleMesh& mesh) {
  std::vector<Corners> all;
  all.reserve(mesh.triangles.size());
  for (const bake::Triangle& t : mesh.triangles) {
    all.push_back(
        {toPoint(mesh.vertices[t[0]]), toPoint(mesh.vertices[t[1]]), toPoint(mesh.vertices[t[2]])});
  }
  return all;
}

}  // namespace galactic::test
