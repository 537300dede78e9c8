#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>

#include "column_grid/triangle_interval.h"
#include "galactic/bake/triangle_mesh.h"
#include "support/oracles/triangle_corners.h"
#include "support/test_meshes.h"

namespace galactic::test {

/// A closed room of box walls with furniture that interpenetrates: a table, a shelf of thin boards,
/// a tilted panel, a ball and some clutter. `origin` is the floor's corner.
inline bake::TriangleMesh furnishedRoom(std::uint32_t seed, const Vec3& origin = {}) {
  MeshBuilder builder;
  const auto at = [&](float x, float y, float z) {
    return Vec3{origin.x + x, origin.y + y, origin.z + z};
  };
  builder.box(at(-0.1F, -0.1F, -0.1F), at(2.6F, 0, 2.1F));
  builder.box(at(-0.1F, 2.4F, -0.1F), at(2.6F, 2.5F, 2.1F));
  builder.box(at(-0.1F, -0.1F, -0.1F), at(0, 2.5F, 2.1F));
  builder.box(at(2.5F, -0.1F, -0.1F), at(2.6F, 2.5F, 2.1F));
  builder.box(at(-0.1F, -0.1F, -0.1F), at(2.6F, 2.5F, 0));
  builder.box(at(-0.1F, -0.1F, 2), at(2.6F, 2.5F, 2.1F));
  builder.box(at(0.51F, 0.71F, 0.62F), at(1.32F, 0.74F, 1.27F));
  builder.box(at(0.55F, -0.01F, 0.66F), at(0.6F, 0.72F, 0.71F));
  builder.box(at(1.2F, -0.01F, 1.1F), at(1.25F, 0.72F, 1.15F));
  for (int board = 0; board < 6; ++board) {
    const float y = 0.1F + 0.31F * static_cast<float>(board);
    builder.box(at(2.15F, y, 0.3F), at(2.5F, y + 0.018F, 1.1F));
  }
  builder.quad(
      {at(0.1F, 0, 1.5F), at(0.1F, 1.2F, 1.9F), at(0.9F, 1.3F, 1.9F), at(0.9F, 0.1F, 1.5F)});
  builder.sphere(at(1.6F, 0.24F, 1.6F), 0.25F, 12);
  builder.soup(seed, 60, {at(0.2F, 0.1F, 0.2F), at(2.3F, 2.2F, 1.8F)}, 0.08F);
  return builder.build();
}

/// Kinds of triangles that are hard on floats.
enum class AwkwardKind {
  kAny,
  kLevel,
  kUpright,
  kUprightEdge,
  kNeedle,
  kSteep,
  kTiny,
  kHuge,
  kCount
};

/// Draws awkward triangles.
class AwkwardSource {
 public:
  explicit AwkwardSource(std::uint32_t seed) : random_(seed) {}

  /// The corners of one, around a point of the unit cube.
  std::array<bake::Point, 3> next(AwkwardKind kind) {
    const double size = sizeOf(kind);
    const bake::Point middle{number(0, 1), number(0, 1), number(0, 1)};
    std::array<bake::Point, 3> t{};
    for (bake::Point& point : t) {
      for (std::size_t c = 0; c < 3; ++c) point[c] = middle[c] + size * number(-0.5, 0.5);
    }
    deform(kind, size, t);
    return t;
  }

 private:
  double number(double lo, double hi) {
    return std::uniform_real_distribution<double>(lo, hi)(random_);
  }

  double sizeOf(AwkwardKind kind) {
    if (kind == AwkwardKind::kTiny) return std::pow(10.0, number(-5, -2));
    if (kind == AwkwardKind::kHuge) return number(1, 3);
    return std::pow(10.0, number(-2, -0.3));
  }

  void deform(AwkwardKind kind, double size, std::array<bake::Point, 3>& t) {
    if (kind == AwkwardKind::kLevel) t[1][1] = t[2][1] = t[0][1];
    if (kind == AwkwardKind::kUpright) t[1][0] = t[2][0] = t[0][0];
    if (kind == AwkwardKind::kUprightEdge) {
      t[1][0] = t[0][0];
      t[1][2] = t[0][2];
    }
    if (kind == AwkwardKind::kSteep) {
      for (bake::Point& point : t) point[0] = t[0][0] + 1e-5 * (point[0] - t[0][0]);
    }
    if (kind != AwkwardKind::kNeedle) return;
    const double part = number(-0.5, 1.5);
    const double aside = size * std::pow(10.0, number(-6, -2));
    for (std::size_t c = 0; c < 3; ++c) {
      t[2][c] = t[0][c] + part * (t[1][c] - t[0][c]) + aside * number(-1, 1);
    }
  }

  std::mt19937_64 random_;
};

/// The least altitude of a triangle: twice its area over its longest edge.
inline double leastAltitude(const Corners& t) {
  const auto edge = [&](std::size_t from, std::size_t to) {
    return bake::Point{t[to][0] - t[from][0], t[to][1] - t[from][1], t[to][2] - t[from][2]};
  };
  const auto length = [](const bake::Point& e) { return std::hypot(e[0], e[1], e[2]); };
  const bake::Point a = edge(0, 1);
  const bake::Point b = edge(0, 2);
  const double twice_area =
      length({a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]});
  return twice_area / std::max({length(a), length(b), length(edge(1, 2))});
}

/// `count` random triangles of all awkward kinds in turn, spread over the cube of one meter whose
/// lowest corner is `corner`. None is lower than kDegenerateHeight, as in a cleaned mesh.
inline bake::TriangleMesh awkwardTriangles(std::uint32_t seed, int count, const Vec3& corner = {}) {
  AwkwardSource source(seed);
  MeshBuilder builder;
  for (int n = 0; n < count;) {
    const auto kind = static_cast<AwkwardKind>(n % static_cast<int>(AwkwardKind::kCount));
    const auto drawn = source.next(kind);
    std::array<Vec3, 3> v;
    for (std::size_t p = 0; p < 3; ++p) {
      v[p] = {static_cast<float>(static_cast<double>(corner.x) + drawn[p][0]),
              static_cast<float>(static_cast<double>(corner.y) + drawn[p][1]),
              static_cast<float>(static_cast<double>(corner.z) + drawn[p][2])};
    }
    const Corners rounded{toPoint(v[0]), toPoint(v[1]), toPoint(v[2])};
    if (!(leastAltitude(rounded) >= bake::kDegenerateHeight)) continue;
    builder.triangle(v[0], v[1], v[2]);
    ++n;
  }
  return builder.build();
}

}  // namespace galactic::test
