#include "fit/box_axes.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

namespace galactic::bake::fit {

void PointSet::add(const Vec3d& point) {
  x.push_back(point.x);
  y.push_back(point.y);
  z.push_back(point.z);
}

PointSet pointSet(std::span<const Vec3> points) {
  PointSet set;
  set.x.reserve(points.size());
  set.y.reserve(points.size());
  set.z.reserve(points.size());
  for (const Vec3& point : points) set.add(widen(point));
  return set;
}

Interval intervalAlong(const PointSet& points, const Vec3d& direction) {
  constexpr std::size_t kLanes = 8;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::array<double, kLanes> lo;
  std::array<double, kLanes> hi;
  lo.fill(kInfinity);
  hi.fill(-kInfinity);
  const double* const x = points.x.data();
  const double* const y = points.y.data();
  const double* const z = points.z.data();
  const std::size_t count = points.size();
  const std::size_t whole = count - count % kLanes;
  for (std::size_t at = 0; at < whole; at += kLanes) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const std::size_t k = at + lane;
      const double here = direction.x * x[k] + direction.y * y[k] + direction.z * z[k];
      lo[lane] = here < lo[lane] ? here : lo[lane];
      hi[lane] = here > hi[lane] ? here : hi[lane];
    }
  }
  for (std::size_t k = whole; k < count; ++k) {
    const double here = direction.x * x[k] + direction.y * y[k] + direction.z * z[k];
    lo[0] = std::min(lo[0], here);
    hi[0] = std::max(hi[0], here);
  }
  return {*std::min_element(lo.begin(), lo.end()), *std::max_element(hi.begin(), hi.end())};
}

double boxVolume(const PointSet& points, const Axes& axes, double min_side) {
  double volume = 1;
  for (const Vec3d& axis : axes) {
    const Interval side = intervalAlong(points, axis);
    volume *= std::max(side.hi - side.lo, min_side);
  }
  return volume;
}

BoxCandidate FixedAxisCalipers::bestAround(const Vec3d& axis) {
  const Axes around = axesAround(axis);
  projected_.clear();
  for (std::size_t at = 0; at < points_.size(); ++at) {
    const Vec3d point = points_[at];
    projected_.push_back({dot(point, around[0]), dot(point, around[1])});
  }
  convexPolygon(projected_, polygon_);
  const Vec2d side = leastRectangleDirection(polygon_, min_side_);
  const Vec3d first = normalized(around[0] * side.x + around[1] * side.y);
  const Axes axes{first, cross(axis, first), axis};
  return {axes, boxVolume(points_, axes, min_side_)};
}

BoxCandidate FixedAxisCalipers::improve(BoxCandidate box, int rounds) {
  constexpr double kWorthwhile = 1 - 1e-9;
  for (int round = 0; round < rounds; ++round) {
    bool improved = false;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const BoxCandidate better = bestAround(box.axes[axis]);
      if (better.volume >= box.volume * kWorthwhile) continue;
      box = better;
      improved = true;
    }
    if (!improved) break;
  }
  return box;
}

namespace {

using Matrix = std::array<std::array<double, 3>, 3>;

Matrix covarianceOf(const PointSet& points) {
  Vec3d mean;
  for (std::size_t at = 0; at < points.size(); ++at) mean = mean + points[at];
  mean = mean * (1 / static_cast<double>(points.size()));
  Matrix covariance{};
  for (std::size_t at = 0; at < points.size(); ++at) {
    const Vec3d from = points[at] - mean;
    const std::array<double, 3> d{from.x, from.y, from.z};
    for (std::size_t row = 0; row < 3; ++row) {
      for (std::size_t column = 0; column < 3; ++column) {
        covariance[row][column] += d[row] * d[column];
      }
    }
  }
  return covariance;
}

/// Rotates a symmetric matrix in the plane of the axes p and q so that its entry (p, q) vanishes.
void rotateAway(Matrix& matrix, Matrix& vectors, std::size_t p, std::size_t q) {
  if (matrix[p][q] == 0) return;
  const double half = (matrix[q][q] - matrix[p][p]) / (2 * matrix[p][q]);
  const double tangent = (half >= 0 ? 1.0 : -1.0) / (std::abs(half) + std::sqrt(half * half + 1));
  const double cosine = 1 / std::sqrt(tangent * tangent + 1);
  const double sine = tangent * cosine;
  const auto turn = [&](double& a, double& b) {
    const double before = a;
    a = cosine * before - sine * b;
    b = sine * before + cosine * b;
  };
  for (std::size_t k = 0; k < 3; ++k) turn(matrix[k][p], matrix[k][q]);
  for (std::size_t k = 0; k < 3; ++k) turn(matrix[p][k], matrix[q][k]);
  for (std::size_t k = 0; k < 3; ++k) turn(vectors[k][p], vectors[k][q]);
}

}  // namespace

Axes principalAxes(const PointSet& points) {
  constexpr int kSweeps = 12;
  Matrix matrix = covarianceOf(points);
  Matrix vectors{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    rotateAway(matrix, vectors, 0, 1);
    rotateAway(matrix, vectors, 0, 2);
    rotateAway(matrix, vectors, 1, 2);
  }
  const Vec3d first = normalized({vectors[0][0], vectors[1][0], vectors[2][0]});
  const Vec3d raw{vectors[0][1], vectors[1][1], vectors[2][1]};
  const Vec3d second = normalized(raw - first * dot(raw, first), axesAround(first)[0]);
  return {first, second, cross(first, second)};
}

namespace {

/// The points at both ends along each of seven directions.
using Extremes = std::array<std::array<Vec3d, 2>, 7>;

std::array<Vec3d, 2> endsAlong(const PointSet& points, const Vec3d& direction) {
  std::array<std::size_t, 2> ends{};
  std::array<double, 2> reach{dot(points[0], direction), dot(points[0], direction)};
  for (std::size_t at = 1; at < points.size(); ++at) {
    const double here = dot(points[at], direction);
    if (here < reach[0]) {
      reach[0] = here;
      ends[0] = at;
    }
    if (here > reach[1]) {
      reach[1] = here;
      ends[1] = at;
    }
  }
  return {points[ends[0]], points[ends[1]]};
}

/// Keeps the axes of the box with the least surface around the extremal points.
class DitoChoice {
 public:
  explicit DitoChoice(const Extremes& extremes) {
    for (const auto& pair : extremes) {
      for (const Vec3d& point : pair) points_.add(point);
    }
    surface_ = surfaceWith(kIdentityAxes);
  }

  /// Tries the normal of a triangle with each of its edges.
  void tryTriangle(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    const Vec3d normal = cross(b - a, c - a);
    if (norm(normal) <= 0) return;
    const Vec3d up = normalized(normal);
    for (const Vec3d& edge : {b - a, c - b, a - c}) {
      const Vec3d side = normalized(edge - up * dot(edge, up));
      const Axes axes{side, cross(up, side), up};
      const double surface = surfaceWith(axes);
      if (surface >= surface_) continue;
      surface_ = surface;
      axes_ = axes;
    }
  }

  [[nodiscard]] const Axes& axes() const { return axes_; }
  [[nodiscard]] const PointSet& points() const { return points_; }

 private:
  [[nodiscard]] double surfaceWith(const Axes& axes) const {
    std::array<double, 3> side{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Interval interval = intervalAlong(points_, axes[axis]);
      side[axis] = interval.hi - interval.lo;
    }
    return side[0] * side[1] + side[1] * side[2] + side[2] * side[0];
  }

  PointSet points_;
  Axes axes_ = kIdentityAxes;
  double surface_ = 0;
};

}  // namespace

Axes ditoAxes(const PointSet& points) {
  constexpr std::array<Vec3d, 7> kDirections{
      {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}, {1, 1, -1}, {1, -1, 1}, {1, -1, -1}}};
  Extremes extremes;
  for (std::size_t at = 0; at < kDirections.size(); ++at) {
    extremes[at] = endsAlong(points, kDirections[at]);
  }
  // The base triangle: the pair farthest apart, and the extremal point farthest from their line.
  const auto* base = &extremes[0];
  for (const auto& pair : extremes) {
    if (norm(pair[1] - pair[0]) > norm((*base)[1] - (*base)[0])) base = &pair;
  }
  const auto [first, second] = *base;
  const Vec3d line = normalized(second - first);
  Vec3d third = first;
  double farthest = 0;
  DitoChoice choice(extremes);
  for (std::size_t at = 0; at < choice.points().size(); ++at) {
    const double distance = norm(cross(choice.points()[at] - first, line));
    if (distance <= farthest) continue;
    farthest = distance;
    third = choice.points()[at];
  }
  choice.tryTriangle(first, second, third);
  // A tetrahedron on either side of the base triangle.
  const Vec3d normal = cross(second - first, third - first);
  for (const Vec3d& apex : endsAlong(points, normal)) {
    choice.tryTriangle(first, second, apex);
    choice.tryTriangle(second, third, apex);
    choice.tryTriangle(third, first, apex);
  }
  return choice.axes();
}

}  // namespace galactic::bake::fit
