#pragma once
#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "ambient/ambient_occlusion.h"
#include "galactic/pose.h"

namespace galactic::test {

/// A mesh of its own for the tests of ambient occlusion.
struct TestMesh {
  std::vector<Vec3> positions;
  std::vector<bake::Triangle> triangles;

  [[nodiscard]] bake::OccludingMesh placed() const {
    bake::OccludingMesh mesh;
    mesh.positions = positions;
    mesh.triangles = triangles;
    return mesh;
  }
};

/// The parallelogram from `corner` along two edges, `cells` x `cells` quads; its front is where
/// cross(u, v) points. Vertex (i, k) is number k * (cells + 1) + i.
inline TestMesh sheet(const Vec3& corner, const Vec3& u, const Vec3& v, unsigned cells) {
  TestMesh mesh;
  const float step = 1.F / static_cast<float>(cells);
  for (unsigned k = 0; k <= cells; ++k) {
    for (unsigned i = 0; i <= cells; ++i) {
      mesh.positions.push_back(corner + u * (static_cast<float>(i) * step) +
                               v * (static_cast<float>(k) * step));
    }
  }
  for (unsigned k = 0; k < cells; ++k) {
    for (unsigned i = 0; i < cells; ++i) {
      const unsigned a = k * (cells + 1) + i;
      const unsigned b = a + cells + 1;
      mesh.triangles.push_back({a, a + 1, b + 1});
      mesh.triangles.push_back({a, b + 1, b});
    }
  }
  return mesh;
}

/// A box of 8 vertices and 12 triangles about the origin that faces outwards, or inwards.
inline TestMesh box(const Vec3& half, bool inwards = false) {
  TestMesh mesh;
  for (unsigned corner = 0; corner < 8; ++corner) {
    mesh.positions.push_back({(corner & 1U) != 0 ? half.x : -half.x,
                              (corner & 2U) != 0 ? half.y : -half.y,
                              (corner & 4U) != 0 ? half.z : -half.z});
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  if (inwards) {
    for (bake::Triangle& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  }
  return mesh;
}

inline std::vector<std::vector<bake::Openness>> opennessOf(
    const std::vector<bake::OccludingMesh>& meshes,
    const bake::AmbientOcclusionOptions& options = {}, unsigned threads = 1) {
  auto result = bake::ambientOcclusion(meshes, options, threads);
  EXPECT_TRUE(result.has_value()) << result.error().message;
  return result ? *std::move(result) : std::vector<std::vector<bake::Openness>>();
}

}  // namespace galactic::test
