#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>

#include "galactic/bake/triangle_mesh.h"
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

/// Random triangles of all the kinds that are hard on floats: level, upright, with an upright edge,
/// needles, steep ones, tiny and huge ones. None is lower than `kDegenerateHeight`, as in a cleaned
/// mesh. `corner` is the lowest corner of the cube of one metre that they are spread over.
inline bake::TriangleMesh awkwardTriangles(std::uint32_t seed, int count, const Vec3& corner = {}) {
  std::mt19937_64 random(seed);
  const auto number = [&](double lo, double hi) {
    return std::uniform_real_distribution<double>(lo, hi)(random);
  };
  constexpr int kKinds = 8;
  MeshBuilder builder;
  for (int n = 0; n < count;) {
    const int kind = n % kKinds;
    const double size = kind == 6 ? std::pow(10.0, number(-5, -2))
                                  : (kind == 7 ? number(1, 3) : std::pow(10.0, number(-2, -0.3)));
    std::array<double, 3> middle{number(0, 1), number(0, 1), number(0, 1)};
    std::array<std::array<double, 3>, 3> t{};
    for (auto& point : t) {
      for (std::size_t c = 0; c < 3; ++c) point[c] = middle[c] + size * number(-0.5, 0.5);
    }
    if (kind == 1) t[1][1] = t[2][1] = t[0][1];
    if (kind == 2) t[1][0] = t[2][0] = t[0][0];
    if (kind == 3) {
      t[1][0] = t[0][0];
      t[1][2] = t[0][2];
    }
    if (kind == 4) {
      const double part = number(-0.5, 1.5);
      const double aside = size * std::pow(10.0, number(-6, -2));
      for (std::size_t c = 0; c < 3; ++c) {
        t[2][c] = t[0][c] + part * (t[1][c] - t[0][c]) + aside * number(-1, 1);
      }
    }
    if (kind == 5) {
      for (auto& point : t) point[0] = t[0][0] + 1e-5 * (point[0] - t[0][0]);
    }
    std::array<Vec3, 3> v;
    for (std::size_t p = 0; p < 3; ++p) {
      v[p] = {static_cast<float>(static_cast<double>(corner.x) + t[p][0]),
              static_cast<float>(static_cast<double>(corner.y) + t[p][1]),
              static_cast<float>(static_cast<double>(corner.z) + t[p][2])};
    }
    // Twice the area over the longest edge is the least altitude.
    const auto edge = [&](std::size_t a, std::size_t b) {
      return std::array<double, 3>{static_cast<double>(v[b].x) - static_cast<double>(v[a].x),
                                   static_cast<double>(v[b].y) - static_cast<double>(v[a].y),
                                   static_cast<double>(v[b].z) - static_cast<double>(v[a].z)};
    };
    const auto length = [](const std::array<double, 3>& e) { return std::hypot(e[0], e[1], e[2]); };
    const auto e0 = edge(0, 1);
    const auto e1 = edge(0, 2);
    const double area = length({e0[1] * e1[2] - e0[2] * e1[1], e0[2] * e1[0] - e0[0] * e1[2],
                                e0[0] * e1[1] - e0[1] * e1[0]});
    const double longest = std::max({length(e0), length(e1), length(edge(1, 2))});
    if (!(area >= bake::kDegenerateHeight * longest)) continue;
    builder.triangle(v[0], v[1], v[2]);
    ++n;
  }
  return builder.build();
}

}  // namespace galactic::test
