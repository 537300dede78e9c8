#pragma once
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <span>
#include <vector>

#include "galactic/bake/triangle_mesh.h"
#include "galactic/pose.h"
#include "support/oracles/box_oracle.h"
#include "support/test_meshes.h"

namespace galactic::test {

inline Quat toQuat(const Rotation& q) {
  const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  return {static_cast<float>(q[1] / length), static_cast<float>(q[2] / length),
          static_cast<float>(q[3] / length), static_cast<float>(q[0] / length)};
}

/// A turn about the upright axis.
inline Quat yawBy(double radians) {
  return {0, static_cast<float>(std::sin(radians / 2)), 0,
          static_cast<float>(std::cos(radians / 2))};
}

/// A number between two others.
inline float between(std::mt19937& random, double lo, double hi) {
  return static_cast<float>(lo + (hi - lo) * uniform(random));
}

inline std::vector<Vec3> moved(std::span<const Vec3> points, const Pose& pose) {
  std::vector<Vec3> result;
  for (const Vec3& point : points) result.push_back(pose * point);
  return result;
}

/// The eight corners of a box around the origin.
inline std::vector<Vec3> cuboid(const Vec3& half) {
  std::vector<Vec3> corners;
  for (const float x : {-half.x, half.x}) {
    for (const float y : {-half.y, half.y}) {
      for (const float z : {-half.z, half.z}) corners.push_back({x, y, z});
    }
  }
  return corners;
}

/// Points of one of four kinds: in a stretched box, in a stretched ball, on it, or a clump with a
/// few outliers; turned at random.
inline std::vector<Vec3> randomPoints(std::mt19937& random, int kind, int count) {
  const Vec3 stretch{between(random, 0.05, 0.3), between(random, 0.05, 0.3),
                     between(random, 0.02, 0.2)};
  const Pose pose{{between(random, -1, 1), between(random, -1, 1), between(random, -1, 1)},
                  toQuat(randomRotation(random))};
  std::vector<Vec3> points;
  while (points.size() < static_cast<std::size_t>(count)) {
    Vec3 point{between(random, -1, 1), between(random, -1, 1), between(random, -1, 1)};
    const float length = std::sqrt(dot(point, point));
    if (kind != 0 && (length > 1 || length < 0.1F)) continue;
    if (kind == 2) point = point * (1 / length);
    if (kind == 3 && points.size() > 4) point = point * 0.3F;
    points.push_back(pose * Vec3{point.x * stretch.x, point.y * stretch.y, point.z * stretch.z});
  }
  return points;
}

/// A mesh that only lists points: what is fitted to hulls does not look at how they are connected.
inline bake::TriangleMesh meshOf(std::span<const Vec3> points) {
  MeshBuilder builder;
  for (std::size_t at = 0; at < points.size(); ++at) {
    builder.triangle(points[at], points[(at + 1) % points.size()],
                     points[(at + 2) % points.size()]);
  }
  return builder.build();
}

struct Ring {
  double radius = 0;
  double height = 0;
};

/// Rings of `sides` points about the Y axis; a radius of zero is one point.
inline std::vector<Vec3> lathe(const std::vector<Ring>& rings, int sides) {
  std::vector<Vec3> points;
  for (const auto& [radius, height] : rings) {
    for (int side = 0; side < (radius > 0 ? sides : 1); ++side) {
      const double turn = 2 * std::numbers::pi * side / sides;
      points.push_back({static_cast<float>(radius * std::cos(turn)), static_cast<float>(height),
                        static_cast<float>(radius * std::sin(turn))});
    }
  }
  return points;
}

}  // namespace galactic::test
