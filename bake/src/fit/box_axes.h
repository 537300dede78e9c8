#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "fit/axes.h"
#include "fit/rectangle_calipers.h"
#include "galactic/pose.h"

namespace galactic::bake::fit {

/// Points, one array per coordinate, so that extents can be computed with vector instructions.
struct PointSet {
  std::vector<double> x;
  std::vector<double> y;
  std::vector<double> z;

  void add(const Vec3d& point);
  [[nodiscard]] std::size_t size() const { return x.size(); }
  [[nodiscard]] Vec3d operator[](std::size_t at) const { return {x[at], y[at], z[at]}; }
};

[[nodiscard]] PointSet pointSet(std::span<const Vec3> points);

/// An extent along a direction.
struct Interval {
  double lo = 0;
  double hi = 0;
};

[[nodiscard]] Interval intervalAlong(const PointSet& points, const Vec3d& direction);

/// Volume of the box with these axes around `points`. Sides shorter than `min_side` count as that
/// long, so that the best box of flat points is the smallest rectangle.
[[nodiscard]] double boxVolume(const PointSet& points, const Axes& axes, double min_side);

/// The axes of a box and its volume.
struct BoxCandidate {
  Axes axes = kIdentityAxes;
  double volume = 0;
};

/// Finds the best box with one axis given. Holds scratch memory, so each thread needs its own.
class FixedAxisCalipers {
 public:
  /// Keeps a reference to `points`, which must outlive this.
  FixedAxisCalipers(const PointSet& points, double min_side)
      : points_(points), min_side_(min_side) {}

  /// The exact optimum for that axis (a unit vector), by rotating calipers around the projected
  /// points.
  [[nodiscard]] BoxCandidate bestAround(const Vec3d& axis);

  /// Repeats bestAround() for each axis of the box until none makes it smaller, or `rounds` times.
  [[nodiscard]] BoxCandidate improve(BoxCandidate box, int rounds);

 private:
  const PointSet& points_;
  double min_side_;
  std::vector<Vec2d> projected_;
  std::vector<Vec2d> polygon_;
};

/// The principal axes of `points` (eigenvectors of their covariance, by Jacobi's method).
[[nodiscard]] Axes principalAxes(const PointSet& points);

/// The axes that the extremal points along seven directions suggest: DiTO-14 of Larsson and
/// Kallberg, "Fast computation of tight-fitting oriented bounding boxes" (2011).
[[nodiscard]] Axes ditoAxes(const PointSet& points);

/// The axes of a box of (nearly) least volume around `points` (meters, finite, at least one). On
/// ten scanned objects, the volume was at most 0.05 % above the best of 200 random starts with
/// descent. Sides shorter than `min_side` count as that long. Flat points get the smallest
/// rectangle, collinear ones their line. Candidates are the principal axes, DiTO-14 and the exact
/// best box around each face normal of the hull (an optimal box is flush with a face or two edges
/// of the hull; O'Rourke 1985). The best of them are improved by calipers about their own axes and
/// by Nelder and Mead's simplex over rotations. Deterministic: effort is counted in steps, not in
/// time.
[[nodiscard]] Axes minimumBoxAxes(std::span<const Vec3> points, double min_side);

}  // namespace galactic::bake::fit
