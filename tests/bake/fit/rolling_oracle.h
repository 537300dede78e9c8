#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <span>
#include <vector>

#include "galactic/pose.h"
#include "support/oracles/box_oracle.h"

namespace galactic::test {

/// Drops a convex body in random attitudes and rolls it face by face. Finds the faces by brute
/// force over all triples of points, so only for few points; shares no code with the bake.
class RollingOracle {
 public:
  using Point = std::array<double, 3>;

  /// A planar face with its corners in order, counter-clockwise seen from outside.
  struct Face {
    Point normal{};
    double offset = 0;
    std::vector<Point> corners{};
  };

  /// Where a drop ended, and after how many rolls.
  struct Rest {
    std::size_t face = 0;
    int rolls = 0;
  };

  explicit RollingOracle(std::span<const Vec3> points) {
    for (const Vec3& p : points) {
      points_.push_back(
          {static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)});
    }
    findFaces();
    findCenter();
  }

  [[nodiscard]] const std::vector<Face>& faces() const { return faces_; }

  [[nodiscard]] Rest drop(std::mt19937& random) const {
    const Point down = randomDirection(random);
    // The face that the ray from the center leaves the body through.
    Rest rest;
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t at = 0; at < faces_.size(); ++at) {
      const double towards = product(faces_[at].normal, down);
      if (towards <= 0) continue;
      const double way = heightAbove(faces_[at]) / towards;
      if (way < nearest) {
        nearest = way;
        rest.face = at;
      }
    }
    for (std::size_t next = roll(rest.face); next != rest.face; next = roll(rest.face)) {
      rest.face = next;
      ++rest.rolls;
    }
    return rest;
  }

 private:
  static Point minus(const Point& a, const Point& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
  }
  static double product(const Point& a, const Point& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  }
  static Point outer(const Point& a, const Point& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  }
  static Point scaled(const Point& a, double by) { return {a[0] * by, a[1] * by, a[2] * by}; }
  static double length(const Point& a) { return std::sqrt(product(a, a)); }

  static Point randomDirection(std::mt19937& random) {
    while (true) {
      const Point p{2 * uniform(random) - 1, 2 * uniform(random) - 1, 2 * uniform(random) - 1};
      const double size = length(p);
      if (size > 0.01 && size < 1) return scaled(p, 1 / size);
    }
  }

  void findFaces() {
    const std::size_t n = points_.size();
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = i + 1; j < n; ++j) {
        for (std::size_t k = j + 1; k < n; ++k) tryPlane(points_[i], points_[j], points_[k]);
      }
    }
  }

  void tryPlane(const Point& a, const Point& b, const Point& c) {
    constexpr double kFlat = 1e-6;
    Point normal = outer(minus(b, a), minus(c, a));
    if (length(normal) < 1e-9) return;
    normal = scaled(normal, 1 / length(normal));
    for (int side = 0; side < 2; ++side, normal = scaled(normal, -1)) {
      const double offset = product(normal, a);
      const bool supports = std::all_of(points_.begin(), points_.end(), [&](const Point& p) {
        return product(normal, p) <= offset + kFlat;
      });
      const bool known = std::any_of(faces_.begin(), faces_.end(), [&](const Face& face) {
        return product(face.normal, normal) > 1 - 1e-9;
      });
      if (supports && !known) addFace(normal, offset, kFlat);
    }
  }

  void addFace(const Point& normal, double offset, double flat) {
    Face face{normal, offset, {}};
    Point middle{};
    for (const Point& p : points_) {
      if (product(normal, p) < offset - flat) continue;
      face.corners.push_back(p);
      for (std::size_t axis = 0; axis < 3; ++axis) middle[axis] += p[axis];
    }
    middle = scaled(middle, 1 / static_cast<double>(face.corners.size()));
    const Point first = minus(face.corners[0], middle);
    const Point second = outer(normal, first);
    const auto angle = [&](const Point& p) {
      const Point from = minus(p, middle);
      return std::atan2(product(from, second), product(from, first));
    };
    std::sort(face.corners.begin(), face.corners.end(),
              [&](const Point& a, const Point& b) { return angle(a) < angle(b); });
    faces_.push_back(std::move(face));
  }

  /// Of the pyramids over the faces with their apex at the first point.
  void findCenter() {
    double volume = 0;
    for (const Face& face : faces_) {
      for (std::size_t at = 2; at < face.corners.size(); ++at) {
        const Point a = minus(face.corners[0], points_[0]);
        const Point b = minus(face.corners[at - 1], points_[0]);
        const Point c = minus(face.corners[at], points_[0]);
        const double part = product(a, outer(b, c)) / 6;
        volume += part;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          center_[axis] += part * (a[axis] + b[axis] + c[axis]) / 4;
        }
      }
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      center_[axis] = points_[0][axis] + center_[axis] / volume;
    }
  }

  [[nodiscard]] double heightAbove(const Face& face) const {
    return face.offset - product(face.normal, center_);
  }

  static double distanceToSegment(const Point& p, const Point& a, const Point& b) {
    const Point along = minus(b, a);
    const double share = std::clamp(product(minus(p, a), along) / product(along, along), 0.0, 1.0);
    return length(minus(minus(p, a), scaled(along, share)));
  }

  /// The face that shares an edge with another; where the foot is nearest to a corner, the edge is
  /// the one that it is farther beyond.
  [[nodiscard]] std::size_t roll(std::size_t index) const {
    const Face& face = faces_[index];
    Point foot = center_;
    for (std::size_t axis = 0; axis < 3; ++axis)
      foot[axis] += face.normal[axis] * heightAbove(face);
    double nearest = std::numeric_limits<double>::infinity();
    double farthest_beyond = 0;
    std::size_t next = index;
    for (std::size_t at = 0; at < face.corners.size(); ++at) {
      const Point& a = face.corners[at];
      const Point& b = face.corners[(at + 1) % face.corners.size()];
      Point out = outer(minus(b, a), face.normal);
      out = scaled(out, 1 / length(out));
      const double beyond = product(minus(foot, a), out);
      if (beyond <= 0) continue;
      const double distance = distanceToSegment(foot, a, b);
      const bool nearer = distance < nearest * (1 - 1e-9);
      const bool as_near = distance < nearest * (1 + 1e-9);
      if (!nearer && !(as_near && beyond > farthest_beyond)) continue;
      nearest = distance;
      farthest_beyond = beyond;
      next = across(index, a, b);
    }
    return next;
  }

  [[nodiscard]] std::size_t across(std::size_t index, const Point& a, const Point& b) const {
    for (std::size_t other = 0; other < faces_.size(); ++other) {
      const auto& corners = faces_[other].corners;
      const auto has = [&](const Point& p) {
        return std::find(corners.begin(), corners.end(), p) != corners.end();
      };
      if (other != index && has(a) && has(b)) return other;
    }
    return index;
  }

  std::vector<Point> points_;
  std::vector<Face> faces_;
  Point center_{};
};

}  // namespace galactic::test
