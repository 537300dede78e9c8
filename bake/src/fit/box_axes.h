#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "fit/axes.h"
#include "fit/rectangle_calipers.h"
#include "galactic/pose.h"

namespace galactic::bake::fit {

/// Points, one array per coordinate, so that extents are taken with vector instructions.
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

/// Volume of the box with these axes around `points`; sides shorter than `min_side` count as that
/// long, so that the best box of flat points is the smallest rectangle.
[[nodiscard]] double boxVolume(const PointSet& points, const Axes& axes, double min_side);

/// Directions of a box and its volume.
struct BoxCandidate {
  Axes axes = kIdentityAxes;
  double volume = 0;
};

/// The best box one of whose axes is a given one. Holds scratch memory: one for each thread.
class FixedAxisCalipers {
 public:
  /// Looks at `points`, which must outlive it.
  FixedAxisCalipers(const PointSet& points, double min_side)
      : points_(points), min_side_(min_side) {}

  /// Exact for that axis (a unit vector): rotating calipers around the points' projection.
  [[nodiscard]] BoxCandidate bestAround(const Vec3d& axis);

  /// Repeats bestAround() each axis of the box until none makes it smaller, or `rounds` times.
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

/// The axes of a box of (nearly) least volume around `points` (meters, finite, at least one): over
/// ten scanned objects at most 0.05 % above the best of 200 random starts walked downhill. Sides
/// shorter than `min_side` count as that long. Flat points get the smallest rectangle, collinear
/// ones their line. Candidates are the points' own axes, DiTO-14 and the exact best box around each
/// face normal of the hull (an optimum has a face flush with the hull or two edges; O'Rourke 1985);
/// the best of them are improved by calipers about their own axes and by Nelder and Mead's simplex
/// over rotations. Deterministic: the effort is counted in steps.
[[nodiscard]] Axes minimumBoxAxes(std::span<const Vec3> points, double min_side);

}  // namespace galactic::bake::fit
