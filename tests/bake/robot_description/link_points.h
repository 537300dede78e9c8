#pragma once
#include <gtest/gtest.h>

#include <array>
#include <variant>

#include "galactic/bake/source_robot.h"
#include "galactic/bake/triangle_mesh.h"

namespace galactic::test {

using Point3 = std::array<double, 3>;

/// `a` times `b`, written down anew: the importer's own code is under test.
inline bake::Affine product(const bake::Affine& a, const bake::Affine& b) {
  bake::Affine c{};
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 4; ++column) {
      double sum = column == 3 ? a[4 * row + 3] : 0;
      for (std::size_t k = 0; k < 3; ++k) sum += a[4 * row + k] * b[4 * k + column];
      c[4 * row + column] = sum;
    }
  }
  return c;
}

inline Point3 pointIn(const bake::Affine& m, const Point3& p) {
  Point3 q{};
  for (std::size_t row = 0; row < 3; ++row) {
    q[row] = m[4 * row] * p[0] + m[4 * row + 1] * p[1] + m[4 * row + 2] * p[2] + m[4 * row + 3];
  }
  return q;
}

/// The triangles of a mesh shape in the frame of its link.
inline bake::TriangleMesh meshInLink(const bake::SourceRobot& robot, const bake::LinkShape& shape) {
  const auto* mesh = std::get_if<bake::MeshShape>(&shape.geometry);
  if (mesh == nullptr) {
    ADD_FAILURE() << "no mesh";
    return {};
  }
  bake::SourceAsset asset = robot.meshes[mesh->mesh];
  for (bake::SourceInstance& instance : asset.instances) {
    instance.world_from_mesh = product(shape.link_from_shape, instance.world_from_mesh);
  }
  auto placed = bake::placeAndClean(asset);
  EXPECT_TRUE(placed.has_value());
  return placed ? std::move(placed->mesh) : bake::TriangleMesh{};
}

/// Positive when the triangles of a closed mesh are counter-clockwise from outside.
inline double signedVolume(const bake::TriangleMesh& mesh) {
  double volume = 0;
  for (const bake::Triangle& t : mesh.triangles) {
    const Vec3& a = mesh.vertices[t[0]];
    const Vec3& b = mesh.vertices[t[1]];
    const Vec3& c = mesh.vertices[t[2]];
    const auto d = [](float v) { return static_cast<double>(v); };
    volume += d(a.x) * (d(b.y) * d(c.z) - d(b.z) * d(c.y)) +
              d(a.y) * (d(b.z) * d(c.x) - d(b.x) * d(c.z)) +
              d(a.z) * (d(b.x) * d(c.y) - d(b.y) * d(c.x));
  }
  return volume / 6;
}

inline void expectBounds(const bake::Bounds& bounds, const Point3& low, const Point3& high,
                         double tolerance = 1e-6) {
  EXPECT_NEAR(static_cast<double>(bounds.min.x), low[0], tolerance);
  EXPECT_NEAR(static_cast<double>(bounds.min.y), low[1], tolerance);
  EXPECT_NEAR(static_cast<double>(bounds.min.z), low[2], tolerance);
  EXPECT_NEAR(static_cast<double>(bounds.max.x), high[0], tolerance);
  EXPECT_NEAR(static_cast<double>(bounds.max.y), high[1], tolerance);
  EXPECT_NEAR(static_cast<double>(bounds.max.z), high[2], tolerance);
}

}  // namespace galactic::test
