#pragma once
#include <algorithm>
#include <array>
#include <cmath>

#include "galactic/pose.h"
#include "galactic/shapes.h"

namespace galactic::test {

/// A point in double precision.
using Point = std::array<double, 3>;

inline Point pointOf(const Vec3& v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

inline Vec3 floatOf(const Point& p) {
  return {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])};
}

inline double distance(const Point& a, const Point& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/// The rotation matrix of a quaternion of any length, row by row.
inline std::array<Point, 3> matrixOf(const Quat& q) {
  const double x = static_cast<double>(q.x);
  const double y = static_cast<double>(q.y);
  const double z = static_cast<double>(q.z);
  const double w = static_cast<double>(q.w);
  const double s = 2 / (x * x + y * y + z * z + w * w);
  return {{{1 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y)},
           {s * (x * y + w * z), 1 - s * (x * x + z * z), s * (y * z - w * x)},
           {s * (x * z - w * y), s * (y * z + w * x), 1 - s * (x * x + y * y)}}};
}

/// The point in the frame that the pose leads to.
inline Point transformed(const Pose& pose, const Point& p) {
  const auto m = matrixOf(pose.rotation);
  Point moved = pointOf(pose.translation);
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t c = 0; c < 3; ++c) moved[row] += m[row][c] * p[c];
  }
  return moved;
}

/// The point in the frame that the pose comes from.
inline Point inverselyTransformed(const Pose& pose, const Point& p) {
  const auto m = matrixOf(pose.rotation);
  const Point origin = pointOf(pose.translation);
  Point moved{};
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t c = 0; c < 3; ++c) moved[c] += m[row][c] * (p[row] - origin[row]);
  }
  return moved;
}

/// A box of an object somewhere in the world, in double precision.
class PlacedBox {
 public:
  PlacedBox(const OrientedBox& box, const Pose& world_from_object)
      : box_(box), world_from_object_(world_from_object) {}

  /// The point at these shares of the half extents, -1 to 1.
  [[nodiscard]] Point at(double x, double y, double z) const {
    const Point half = pointOf(box_.half_extents);
    return transformed(world_from_object_,
                       transformed(box_.pose, {x * half[0], y * half[1], z * half[2]}));
  }

  /// The point of the box that is nearest to `p`.
  [[nodiscard]] Point nearest(const Point& p) const {
    Point inside = inverselyTransformed(box_.pose, inverselyTransformed(world_from_object_, p));
    const Point half = pointOf(box_.half_extents);
    for (std::size_t c = 0; c < 3; ++c) inside[c] = std::clamp(inside[c], -half[c], half[c]);
    return transformed(world_from_object_, transformed(box_.pose, inside));
  }

  /// Distance of two boxes by alternating projections (von Neumann), which approach the nearest
  /// points of two convex bodies.
  [[nodiscard]] double distanceTo(const PlacedBox& other) const {
    constexpr int kRounds = 400;
    Point here = at(0, 0, 0);
    Point there = other.nearest(here);
    for (int round = 0; round < kRounds; ++round) {
      here = nearest(there);
      there = other.nearest(here);
    }
    return distance(here, there);
  }

  /// The greatest and least height of a corner.
  [[nodiscard]] double top() const { return extremeHeight(1); }
  [[nodiscard]] double bottom() const { return extremeHeight(-1); }

 private:
  [[nodiscard]] double extremeHeight(double sign) const {
    double best = -sign * 1e30;
    for (int corner = 0; corner < 8; ++corner) {
      const Point p =
          at((corner & 1) != 0 ? 1 : -1, (corner & 2) != 0 ? 1 : -1, (corner & 4) != 0 ? 1 : -1);
      best = sign > 0 ? std::max(best, p[1]) : std::min(best, p[1]);
    }
    return best;
  }

  OrientedBox box_;
  Pose world_from_object_;
};

}  // namespace galactic::test
