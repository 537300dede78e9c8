#include "pack_tool/mesh/sphere_mesh.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "galactic/pose.h"

namespace galactic::pack_tool {

namespace {

Vec3 unit(const Vec3& v) { return v * (1 / std::sqrt(dot(v, v))); }

SphereMesh icosahedron() {
  const float golden = 0.5F * (1 + std::sqrt(5.0F));
  SphereMesh mesh;
  for (const Vec3& p :
       {Vec3{-1, golden, 0}, Vec3{1, golden, 0}, Vec3{-1, -golden, 0}, Vec3{1, -golden, 0},
        Vec3{0, -1, golden}, Vec3{0, 1, golden}, Vec3{0, -1, -golden}, Vec3{0, 1, -golden},
        Vec3{golden, 0, -1}, Vec3{golden, 0, 1}, Vec3{-golden, 0, -1}, Vec3{-golden, 0, 1}}) {
    mesh.points.push_back(unit(p));
  }
  mesh.corners = {0, 11, 5,  0, 5,  1, 0, 1, 7, 0, 7,  10, 0, 10, 11, 1, 5, 9, 5, 11,
                  4, 11, 10, 2, 10, 7, 6, 7, 1, 8, 3,  9,  4, 3,  4,  2, 3, 2, 6, 3,
                  6, 8,  3,  8, 9,  4, 9, 5, 2, 4, 11, 6,  2, 10, 8,  6, 7, 9, 8, 1};
  return mesh;
}

/// Each triangle as four.
SphereMesh cut(const SphereMesh& coarse) {
  SphereMesh fine{coarse.points, {}};
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
  const auto middle = [&](std::uint32_t a, std::uint32_t b) {
    const auto [found, added] =
        middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(fine.points.size()));
    if (added) fine.points.push_back(unit(coarse.points[a] + coarse.points[b]));
    return found->second;
  };
  for (std::size_t n = 0; n < coarse.corners.size(); n += 3) {
    const std::uint32_t a = coarse.corners[n];
    const std::uint32_t b = coarse.corners[n + 1];
    const std::uint32_t c = coarse.corners[n + 2];
    const std::uint32_t ab = middle(a, b);
    const std::uint32_t bc = middle(b, c);
    const std::uint32_t ca = middle(c, a);
    fine.corners.insert(fine.corners.end(), {a, ab, ca, b, bc, ab, c, ca, bc, ab, bc, ca});
  }
  return fine;
}

}  // namespace

SphereMesh makeSphereMesh(int cuts) {
  SphereMesh mesh = icosahedron();
  for (int n = 0; n < cuts; ++n) mesh = cut(mesh);
  return mesh;
}

}  // namespace galactic::pack_tool
