#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>

#include "galactic/bake/triangle_mesh.h"
#include "galactic/pose.h"

namespace galactic::test {

/// Collects triangles, in the world frame, into a mesh for tests. Takes what it is given: no
/// cleaning.
class MeshBuilder {
 public:
  MeshBuilder& triangle(Vec3 a, Vec3 b, Vec3 c) {
    const auto first = static_cast<std::uint32_t>(mesh_.vertices.size());
    mesh_.vertices.insert(mesh_.vertices.end(), {a, b, c});
    mesh_.triangles.push_back({first, first + 1, first + 2});
    return *this;
  }

  /// Corners in order around the quad.
  MeshBuilder& quad(const std::array<Vec3, 4>& q) {
    return triangle(q[0], q[1], q[2]).triangle(q[0], q[2], q[3]);
  }

  /// A horizontal rectangle at height `y`.
  MeshBuilder& floor(Vec3 min, Vec3 max, float y) {
    return quad({Vec3{min.x, y, min.z}, {min.x, y, max.z}, {max.x, y, max.z}, {max.x, y, min.z}});
  }

  /// The closed surface of an axis-aligned box.
  MeshBuilder& box(Vec3 min, Vec3 max) {
    const auto corner = [&](int bits) {
      return Vec3{(bits & 1) != 0 ? max.x : min.x, (bits & 2) != 0 ? max.y : min.y,
                  (bits & 4) != 0 ? max.z : min.z};
    };
    const std::array<std::array<int, 4>, 6> faces{
        {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};
    for (const auto& f : faces) quad({corner(f[0]), corner(f[1]), corner(f[2]), corner(f[3])});
    return *this;
  }

  /// A sphere of `rings` rows of triangles between the poles and twice as many around; its vertices
  /// lie on the sphere.
  MeshBuilder& sphere(Vec3 center, float radius, int rings) {
    const int around = 2 * rings;
    const auto point = [&](int ring, int step) {
      const double polar = std::numbers::pi * ring / rings;
      const double turn = 2 * std::numbers::pi * (step % around) / around;
      const double r = static_cast<double>(radius);
      return Vec3{
          static_cast<float>(static_cast<double>(center.x) + r * std::sin(polar) * std::cos(turn)),
          static_cast<float>(static_cast<double>(center.y) + r * std::cos(polar)),
          static_cast<float>(static_cast<double>(center.z) + r * std::sin(polar) * std::sin(turn))};
    };
    for (int ring = 0; ring < rings; ++ring) {
      for (int step = 0; step < around; ++step) {
        const Vec3 a = point(ring, step);
        const Vec3 b = point(ring, step + 1);
        const Vec3 c = point(ring + 1, step + 1);
        const Vec3 d = point(ring + 1, step);
        if (ring > 0) triangle(a, b, c);
        if (ring + 1 < rings) triangle(a, c, d);
      }
    }
    return *this;
  }

  /// `count` triangles with corners up to `size` from points spread evenly over `bounds`.
  MeshBuilder& soup(std::uint32_t seed, int count, const bake::Bounds& bounds, float size) {
    std::mt19937 random(seed);
    const auto between = [&](float lo, float hi) {
      return std::uniform_real_distribution<float>(lo, hi)(random);
    };
    for (int i = 0; i < count; ++i) {
      const Vec3 middle{between(bounds.min.x, bounds.max.x), between(bounds.min.y, bounds.max.y),
                        between(bounds.min.z, bounds.max.z)};
      std::array<Vec3, 3> corners;
      for (Vec3& corner : corners) {
        corner = {middle.x + between(-size, size), middle.y + between(-size, size),
                  middle.z + between(-size, size)};
      }
      triangle(corners[0], corners[1], corners[2]);
    }
    return *this;
  }

  /// The mesh with its bounds.
  [[nodiscard]] bake::TriangleMesh build() const {
    bake::TriangleMesh mesh = mesh_;
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    mesh.bounds = {{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
    for (const Vec3& v : mesh.vertices) {
      mesh.bounds.min = {std::min(mesh.bounds.min.x, v.x), std::min(mesh.bounds.min.y, v.y),
                         std::min(mesh.bounds.min.z, v.z)};
      mesh.bounds.max = {std::max(mesh.bounds.max.x, v.x), std::max(mesh.bounds.max.y, v.y),
                         std::max(mesh.bounds.max.z, v.z)};
    }
    return mesh;
  }

 private:
  bake::TriangleMesh mesh_;
};

}  // namespace galactic::test
