#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "column_grid/blocked_intervals.h"
#include "column_grid/triangle_interval.h"
#include "galactic/bake/columns.h"
#include "support/test_meshes.h"

namespace galactic::test {

/// Three by three columns, the middle one at (x, z).
inline bake::GridFrame frameAround(float x, float z, float radius, Span heights) {
  constexpr float kSpacing = 0.03F;
  bake::GridFrame frame;
  frame.radius = radius;
  frame.spacing = kSpacing;
  frame.min_x = x - 1.5F * kSpacing;
  frame.min_z = z - 1.5F * kSpacing;
  frame.heights = heights;
  frame.columns_x = frame.columns_z = 3;
  return frame;
}

/// A frame over all of a small mesh.
inline bake::GridFrame frameOver(const bake::TriangleMesh& mesh, float radius, float spacing) {
  return bake::makeGridFrame(mesh.bounds, radius, spacing).value();
}

/// The free spans by brute force: every triangle against every column, in double.
inline bake::Columns bruteForceColumns(const bake::TriangleMesh& mesh,
                                       const bake::GridFrame& frame) {
  std::vector<std::array<bake::Point, 3>> triangles;
  for (const bake::Triangle& triangle : mesh.triangles) {
    std::array<bake::Point, 3> corners{};
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& v = mesh.vertices[triangle[k]];
      corners[k] = {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
    }
    triangles.push_back(corners);
  }
  bake::Columns columns;
  columns.frame = frame;
  columns.first.push_back(0);
  for (std::uint32_t k = 0; k < frame.columns_z; ++k) {
    for (std::uint32_t i = 0; i < frame.columns_x; ++i) {
      std::vector<bake::BlockedInterval> blocked;
      for (const auto& corners : triangles) {
        const auto found = bake::touchingHeights(corners, frame.centerX(i), frame.centerZ(k),
                                                 static_cast<double>(frame.radius));
        if (!found) continue;
        blocked.push_back({static_cast<float>(found->lo), static_cast<float>(found->hi)});
      }
      bake::appendFreeSpans(blocked, frame.heights, columns.spans);
      columns.first.push_back(static_cast<std::uint32_t>(columns.spans.size()));
    }
  }
  return columns;
}

/// `count` small rooms' worth of random triangles in a cube of one meter, its corner at `corner`.
inline bake::TriangleMesh randomSoup(std::uint32_t seed, int count, Vec3 corner = {}) {
  return MeshBuilder()
      .soup(seed, count, {corner, {corner.x + 1, corner.y + 1, corner.z + 1}}, 0.15F)
      .build();
}

}  // namespace galactic::test
