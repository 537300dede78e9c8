#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <random>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "galactic/bake/sphere_set.h"
#include "galactic/bake/triangle_mesh.h"
#include "support/oracles/triangle_corners.h"
#include "support/test_meshes.h"

namespace galactic::test {

/// A solid whose signed distance is known in closed form: the oracle of these tests.
struct KnownSolid {
  bake::TriangleMesh mesh;
  /// Signed distance of a point, negative inside, meters.
  std::function<double(const bake::Point&)> distance;
  /// How far the triangles lie from the true surface at most, meters.
  double error = 0;
};

/// The surface that a polyline of (radius, height) sweeps around the Y axis.
inline bake::TriangleMesh revolved(const std::vector<std::pair<double, double>>& profile,
                                   int around) {
  MeshBuilder builder;
  const auto point = [&](std::size_t row, int step) {
    const double turn = 2 * std::numbers::pi * (step % around) / around;
    return Vec3{static_cast<float>(profile[row].first * std::cos(turn)),
                static_cast<float>(profile[row].second),
                static_cast<float>(profile[row].first * std::sin(turn))};
  };
  for (std::size_t row = 0; row + 1 < profile.size(); ++row) {
    for (int step = 0; step < around; ++step) {
      const Vec3 a = point(row, step);
      const Vec3 b = point(row, step + 1);
      const Vec3 c = point(row + 1, step + 1);
      const Vec3 d = point(row + 1, step);
      if (profile[row].first > 0) builder.triangle(a, d, b);
      if (profile[row + 1].first > 0) builder.triangle(b, d, c);
    }
  }
  return builder.build();
}

/// How far a regular polygon's edges lie within its circle.
inline double sagitta(double radius, int around) {
  return radius * (1 - std::cos(std::numbers::pi / around));
}

inline KnownSolid ball(double radius) {
  MeshBuilder builder;
  builder.sphere({0, 0, 0}, static_cast<float>(radius), 48);
  return {builder.build(),
          [=](const bake::Point& p) { return std::hypot(p[0], p[1], p[2]) - radius; },
          2 * sagitta(radius, 96)};
}

/// Centered on the origin.
inline KnownSolid box(double x, double y, double z) {
  MeshBuilder builder;
  builder.box({static_cast<float>(-x / 2), static_cast<float>(-y / 2), static_cast<float>(-z / 2)},
              {static_cast<float>(x / 2), static_cast<float>(y / 2), static_cast<float>(z / 2)});
  return {builder.build(), [=](const bake::Point& p) {
            const double dx = std::fabs(p[0]) - x / 2;
            const double dy = std::fabs(p[1]) - y / 2;
            const double dz = std::fabs(p[2]) - z / 2;
            const double out = std::hypot(std::max(dx, 0.0), std::max(dy, 0.0), std::max(dz, 0.0));
            return out + std::min(std::max({dx, dy, dz}), 0.0);
          }};
}

/// Upright and centered on the origin.
inline KnownSolid cylinder(double radius, double length) {
  constexpr int kAround = 96;
  std::vector<std::pair<double, double>> profile{{0, -length / 2}};
  const int rows = 24;
  for (int row = 0; row <= rows; ++row)
    profile.emplace_back(radius, length * row / rows - length / 2);
  profile.emplace_back(0, length / 2);
  return {revolved(profile, kAround),
          [=](const bake::Point& p) {
            const double across = std::hypot(p[0], p[2]) - radius;
            const double along = std::fabs(p[1]) - length / 2;
            return std::hypot(std::max(across, 0.0), std::max(along, 0.0)) +
                   std::min(std::max(across, along), 0.0);
          },
          sagitta(radius, kAround)};
}

/// Upright: `length` between the centers of the caps.
inline KnownSolid capsule(double radius, double length) {
  constexpr int kAround = 96;
  constexpr int kRows = 24;
  std::vector<std::pair<double, double>> profile;
  for (int row = 0; row <= 2 * kRows; ++row) {
    const double turn = std::numbers::pi * row / (2 * kRows);
    const double end = row < kRows ? -length / 2 : length / 2;
    const double across = row == 0 || row == 2 * kRows ? 0 : radius * std::sin(turn);
    profile.emplace_back(across, end - radius * std::cos(turn));
    if (row == kRows) profile.back() = {radius, -length / 2};
    if (row == kRows) profile.emplace_back(radius, length / 2);
  }
  return {revolved(profile, kAround),
          [=](const bake::Point& p) {
            const double along = std::max(std::fabs(p[1]) - length / 2, 0.0);
            return std::hypot(p[0], p[2], along) - radius;
          },
          2 * sagitta(radius, kAround)};
}

/// Points drawn uniformly from a mesh's surface: the oracle's own, unlike the solver's.
inline std::vector<bake::Point> randomSurfacePoints(const bake::TriangleMesh& mesh,
                                                    std::uint32_t seed, std::size_t count) {
  const std::vector<Corners> triangles = allCorners(mesh);
  std::vector<double> ends;
  double area = 0;
  for (const Corners& t : triangles) {
    std::array<double, 3> u{};
    std::array<double, 3> v{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      u[axis] = t[1][axis] - t[0][axis];
      v[axis] = t[2][axis] - t[0][axis];
    }
    area += std::hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                       u[0] * v[1] - u[1] * v[0]) /
            2;
    ends.push_back(area);
  }
  std::mt19937 random(seed);
  const auto unit = [&] { return static_cast<double>(random()) * 0x1p-32; };
  std::vector<bake::Point> points;
  for (std::size_t n = 0; n < count; ++n) {
    const auto found = std::lower_bound(ends.begin(), ends.end(), unit() * area);
    const auto last = static_cast<std::ptrdiff_t>(triangles.size()) - 1;
    const Corners& t = triangles[static_cast<std::size_t>(std::min(found - ends.begin(), last))];
    double a = unit();
    double b = unit();
    if (a + b > 1) {
      a = 1 - a;
      b = 1 - b;
    }
    bake::Point p{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      p[axis] = t[0][axis] * (1 - a - b) + t[1][axis] * a + t[2][axis] * b;
    }
    points.push_back(p);
  }
  return points;
}

/// Distance of a point to the union of the spheres, negative inside.
inline double gapOf(const bake::Point& p, const std::vector<SetSphere>& spheres,
                    const std::vector<float>& radii) {
  double least = HUGE_VAL;
  for (const SetSphere& sphere : spheres) {
    const bake::Point c = toPoint(sphere.center);
    least = std::min(least, std::hypot(p[0] - c[0], p[1] - c[1], p[2] - c[2]) -
                                static_cast<double>(radii.at(sphere.radius_index)));
  }
  return least;
}

/// Points drawn uniformly from the spheres' surfaces, `each` per sphere.
inline std::vector<bake::Point> randomSpherePoints(const std::vector<SetSphere>& spheres,
                                                   const std::vector<float>& radii,
                                                   std::uint32_t seed, int each) {
  std::mt19937 random(seed);
  const auto unit = [&] { return static_cast<double>(random()) * 0x1p-32; };
  std::vector<bake::Point> points;
  for (const SetSphere& sphere : spheres) {
    const auto radius = static_cast<double>(radii.at(sphere.radius_index));
    for (int n = 0; n < each; ++n) {
      const double y = 2 * unit() - 1;
      const double turn = 2 * std::numbers::pi * unit();
      const double ring = std::sqrt(1 - y * y);
      const bake::Point c = toPoint(sphere.center);
      points.push_back({c[0] + radius * ring * std::cos(turn), c[1] + radius * y,
                        c[2] + radius * ring * std::sin(turn)});
    }
  }
  return points;
}

/// Spheres per radius, largest radius first, for messages: "0/2/5".
inline std::string countsOf(const bake::SphereSet& set, std::size_t radii) {
  std::ostringstream text;
  for (std::size_t rank = radii; rank-- > 0;) {
    text << std::count_if(set.spheres.begin(), set.spheres.end(), [&](const SetSphere& sphere) {
      return sphere.radius_index == rank;
    }) << (rank > 0 ? "/" : "");
  }
  return text.str();
}

}  // namespace galactic::test
