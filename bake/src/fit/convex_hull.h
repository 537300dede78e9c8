#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "fit/axes.h"
#include "galactic/pose.h"

namespace galactic::bake::fit {

/// `points` (finite) without duplicates, in ascending order of x, y, z, so that a fit depends
/// neither on their order nor on how often a mesh repeats its vertices.
[[nodiscard]] std::vector<Vec3> uniquePoints(std::span<const Vec3> points);

/// The dimension of a set of points.
enum class HullShape { kPoint, kLine, kPlane, kSolid };

/// A corner of a hull.
struct HullCorner {
  /// Index of the input point.
  std::uint32_t source = 0;
  /// The point as the hull's computation rounded it, within kHullRounding of the source. With
  /// these, the faces are convex to about float rounding. Do not measure extents from them.
  Vec3d rounded;
};

/// The convex hull of points.
struct ConvexHull {
  HullShape shape = HullShape::kPoint;
  /// The direction of the longest extent (approximately), of the widest extent across it, and of
  /// the least thickness. The last is exact: the normal of the plane for kPlane. The identity for a
  /// point.
  Axes frame = kIdentityAxes;
  /// One for a point, the two ends for a line, and the polygon, counter-clockwise about frame[2],
  /// for a plane.
  std::vector<HullCorner> corners;
  /// For a solid only: the corners of each face, counter-clockwise as seen from outside. Faces are
  /// planar up to rounding, and neighbors may be coplanar up to rounding, too.
  std::vector<std::vector<std::uint32_t>> faces;
};

/// A corner is moved by at most this share of the hull's extent along each axis of the computation.
inline constexpr double kHullRounding = 1e-4;
/// Point sets thinner than this share of their length count as flat, and so do those thinner than
/// kFloatNoise times their greatest coordinate.
inline constexpr double kFlatRatio = 1e-6;
inline constexpr double kFloatNoise = 2.5e-7;

/// The convex hull of `points` (meters, finite, at least one), by Bullet's exact integer hull
/// (Preparata and Hong) of the points rounded to a grid. Sets without volume become a point, a line
/// or a plane, found without Bullet. Deterministic: depends only on the points and their order.
/// Takes up to 600 bytes per point, and throws std::bad_alloc if they are not available.
[[nodiscard]] ConvexHull convexHull(std::span<const Vec3> points);

/// Indices of faces of a hull that lie in one plane, up to the hull's rounding.
using Facet = std::vector<std::uint32_t>;

/// How far the hull's rounding may have moved faces off a common plane, meters: the `tolerance` of
/// the functions below.
[[nodiscard]] double planeTolerance(const ConvexHull& hull);

/// The planar facets of `hull` (kSolid), in descending order of their largest face. Every face
/// belongs to one.
[[nodiscard]] std::vector<Facet> planarFacets(const ConvexHull& hull, double tolerance);

/// The outward unit normal of a facet of the hull of `points`. It is computed from the corners'
/// sources, which carry only the rounding of floats, unless the plane of the sources cuts through
/// the body because the hull's rounding decided which points are corners; then from the rounded
/// corners.
[[nodiscard]] Vec3d facetNormal(const ConvexHull& hull, std::span<const Vec3> points,
                                const Facet& facet, double tolerance);

}  // namespace galactic::bake::fit
