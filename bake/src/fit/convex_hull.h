#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "fit/axes.h"
#include "galactic/pose.h"

namespace galactic::bake::fit {

/// `points` (finite) without repetitions, in ascending order of x, y, z: what is fitted to them
/// depends neither on their order nor on how often a mesh repeats its vertices.
[[nodiscard]] std::vector<Vec3> uniquePoints(std::span<const Vec3> points);

/// How many dimensions a set of points fills.
enum class HullShape { kPoint, kLine, kPlane, kSolid };

/// A corner of a hull.
struct HullCorner {
  /// Index of the input point that it is.
  std::uint32_t source = 0;
  /// Where the hull's computation has it: within kHullRounding of the source, so that the faces are
  /// convex to about float rounding. Not the place to measure extents from.
  Vec3d rounded;
};

/// The convex hull of points.
struct ConvexHull {
  HullShape shape = HullShape::kPoint;
  /// Longest extent (approximately), the widest across it, and the direction of least thickness,
  /// which is exactly the normal of a plane. The identity for a point.
  Axes frame = kIdentityAxes;
  /// Point: one. Line: its two ends. Plane: the polygon, counter-clockwise about frame[2].
  std::vector<HullCorner> corners;
  /// Of a solid only: each face's corners, counter-clockwise seen from outside. Faces are planar
  /// up to rounding; neighbors may be coplanar up to rounding too.
  std::vector<std::vector<std::uint32_t>> faces;
};

/// A corner is rounded by at most this share of the hull's extent along each axis of its
/// computation.
inline constexpr double kHullRounding = 1e-4;
/// Points thinner than this share of their length fill no volume, nor do those thinner than
/// kFloatNoise times their greatest coordinate.
inline constexpr double kFlatRatio = 1e-6;
inline constexpr double kFloatNoise = 2.5e-7;

/// The convex hull of `points` (meters, finite, at least one), by Bullet's exact integer hull
/// (Preparata and Hong) of the points rounded to a grid. What fills no volume is a point, a line or
/// a plane, found without Bullet. Deterministic: a function of the points in their order. Takes
/// up to 600 bytes a point, and throws std::bad_alloc where they are not there.
[[nodiscard]] ConvexHull convexHull(std::span<const Vec3> points);

/// Faces of a hull that lie in one plane, but for the hull's rounding: indices of faces.
using Facet = std::vector<std::uint32_t>;

/// How near faces of `hull` are to one plane that its rounding may have kept off it, meters: the
/// `tolerance` of what follows.
[[nodiscard]] double planeTolerance(const ConvexHull& hull);

/// The planar facets of `hull` (kSolid), in the order of their largest faces, largest first. Every
/// face belongs to one.
[[nodiscard]] std::vector<Facet> planarFacets(const ConvexHull& hull, double tolerance);

/// The outward unit normal of a facet of the hull of `points`: of the corners' sources, which carry
/// the rounding of floats alone; of the rounded corners where the hull's rounding decided which
/// corners there are, so that the plane of their sources cuts through the body.
[[nodiscard]] Vec3d facetNormal(const ConvexHull& hull, std::span<const Vec3> points,
                                const Facet& facet, double tolerance);

}  // namespace galactic::bake::fit
