#include "import/polygon_triangulation.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace galactic::bake {
namespace {

/// A corner projected along the polygon's main normal axis, in double precision.
struct FlatPoint {
  double u = 0;
  double v = 0;
};

/// Twice the signed area of a triangle; positive when counter-clockwise.
double cross(const FlatPoint& a, const FlatPoint& b, const FlatPoint& c) {
  return (b.u - a.u) * (c.v - a.v) - (b.v - a.v) * (c.u - a.u);
}

std::array<double, 3> newellNormal(std::span<const std::uint32_t> corners,
                                   std::span<const Vec3> positions) {
  // Relative to the first corner, so that far-off polygons keep their digits.
  const Vec3& o = positions[corners[0]];
  const auto relative = [&](std::uint32_t corner) {
    const Vec3& p = positions[corner];
    return std::array<double, 3>{static_cast<double>(p.x) - static_cast<double>(o.x),
                                 static_cast<double>(p.y) - static_cast<double>(o.y),
                                 static_cast<double>(p.z) - static_cast<double>(o.z)};
  };
  std::array<double, 3> normal{};
  auto a = relative(corners.back());
  for (const std::uint32_t corner : corners) {
    const auto b = relative(corner);
    normal[0] += (a[1] - b[1]) * (a[2] + b[2]);
    normal[1] += (a[2] - b[2]) * (a[0] + b[0]);
    normal[2] += (a[0] - b[0]) * (a[1] + b[1]);
    a = b;
  }
  return normal;
}

/// The polygon seen from the side that its main normal axis points to, hence counter-clockwise.
std::vector<FlatPoint> flattened(std::span<const std::uint32_t> corners,
                                 std::span<const Vec3> positions) {
  const auto normal = newellNormal(corners, positions);
  const auto largest = std::max_element(
      normal.begin(), normal.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
  const auto axis = static_cast<std::size_t>(largest - normal.begin());
  std::size_t u = (axis + 1) % 3;
  std::size_t v = (axis + 2) % 3;
  if (*largest < 0) std::swap(u, v);
  std::vector<FlatPoint> points;
  points.reserve(corners.size());
  for (const std::uint32_t corner : corners) {
    const Vec3& p = positions[corner];
    const std::array<double, 3> xyz{static_cast<double>(p.x), static_cast<double>(p.y),
                                    static_cast<double>(p.z)};
    points.push_back({xyz[u], xyz[v]});
  }
  return points;
}

/// What is left of a polygon while its ears are clipped.
class EarClipper {
 public:
  EarClipper(std::vector<FlatPoint> points, std::uint64_t& comparisons_left)
      : points_(std::move(points)), comparisons_left_(comparisons_left) {
    for (std::size_t i = 0; i < points_.size(); ++i) left_.push_back(i);
  }

  /// Calls `cut` with the three corners of each ear, in the polygon's order. Returns false if this
  /// takes more comparisons than are left.
  template <class Cut>
  bool run(const Cut& cut) {
    std::size_t at = 0;
    std::size_t failures = 0;
    while (left_.size() > 3) {
      const std::size_t n = left_.size();
      const std::size_t before = left_[(at + n - 1) % n];
      const std::size_t here = left_[at % n];
      const std::size_t after = left_[(at + 1) % n];
      // If a whole round finds no ear, the polygon crosses itself: cut anywhere, so that the loop
      // ends.
      if (comparisons_left_ == 0) return false;
      if (failures < n && !isEar(before, here, after)) {
        ++failures;
        at = (at + 1) % n;
        continue;
      }
      cut(before, here, after);
      left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(at % n));
      failures = 0;
      at %= left_.size();
    }
    cut(left_[0], left_[1], left_[2]);
    return true;
  }

 private:
  [[nodiscard]] bool isEar(std::size_t before, std::size_t here, std::size_t after) {
    const FlatPoint& a = points_[before];
    const FlatPoint& b = points_[here];
    const FlatPoint& c = points_[after];
    comparisons_left_ -= std::min<std::uint64_t>(comparisons_left_, 1);
    if (cross(a, b, c) <= 0) return false;
    const auto obstacle = std::find_if(left_.begin(), left_.end(), [&](std::size_t other) {
      const FlatPoint& p = points_[other];
      if (other == before || other == here || other == after) return false;
      // Corners at the same place (a bridge to a hole) do not obstruct.
      const auto same = [&](const FlatPoint& q) { return p.u == q.u && p.v == q.v; };
      if (same(a) || same(b) || same(c)) return false;
      return cross(a, b, p) >= 0 && cross(b, c, p) >= 0 && cross(c, a, p) >= 0;
    });
    const auto compared = static_cast<std::uint64_t>(obstacle - left_.begin());
    comparisons_left_ -= std::min(comparisons_left_, compared);
    return obstacle == left_.end();
  }

  std::vector<FlatPoint> points_;
  std::uint64_t& comparisons_left_;
  std::vector<std::size_t> left_;
};

}  // namespace

bool triangulatePolygon(std::span<const std::uint32_t> corners, std::span<const Vec3> positions,
                        std::uint64_t& comparisons_left, std::vector<Triangle>& triangles) {
  if (corners.size() < 3) return true;
  const bool in_range = std::all_of(corners.begin(), corners.end(), [&](std::uint32_t corner) {
    return corner < positions.size();
  });
  if (corners.size() == 3 || !in_range) {
    for (std::size_t i = 2; i < corners.size(); ++i) {
      triangles.push_back({corners[0], corners[i - 1], corners[i]});
    }
    return true;
  }
  return EarClipper(flattened(corners, positions), comparisons_left)
      .run([&](std::size_t a, std::size_t b, std::size_t c) {
        triangles.push_back({corners[a], corners[b], corners[c]});
      });
}

}  // namespace galactic::bake
