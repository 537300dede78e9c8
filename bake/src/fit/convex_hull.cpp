// The only file that names Bullet's hull.
#include "fit/convex_hull.h"

#include <LinearMath/btConvexHullComputer.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>

#include "engines/bullet_memory.h"
#include "fit/rectangle_calipers.h"

namespace galactic::bake::fit {
namespace {

/// Points that are thinner than this share of their length are rounded along the axes of their own
/// frame. Bullet rounds each axis to a share of its extent, which must not mix length and
/// thickness.
constexpr double kThinRatio = 0.05;

/// How the points are spread: an origin among them, and their extents along their own frame.
struct Spread {
  Vec3d origin;
  Axes frame = kIdentityAxes;
  double length = 0;
  double width = 0;
  double thickness = 0;
  /// Extents that are not greater count as 0.
  double tolerance = 0;
  std::size_t first_end = 0;
  std::size_t last_end = 0;
};

/// Index of the point with the greatest value; the first one if several are equal.
template <class Value>
std::size_t greatest(std::span<const Vec3> points, const Value& value) {
  std::size_t best = 0;
  double best_value = value(widen(points[0]));
  for (std::size_t at = 1; at < points.size(); ++at) {
    const double here = value(widen(points[at]));
    if (here > best_value) {
      best_value = here;
      best = at;
    }
  }
  return best;
}

std::size_t farthestFrom(std::span<const Vec3> points, const Vec3d& place) {
  return greatest(points, [&](const Vec3d& p) { return dot(p - place, p - place); });
}

double extentAlong(std::span<const Vec3> points, const Vec3d& direction) {
  double lo = dot(widen(points[0]), direction);
  double hi = lo;
  for (const Vec3& point : points) {
    const double here = dot(widen(point), direction);
    lo = std::min(lo, here);
    hi = std::max(hi, here);
  }
  return hi - lo;
}

Spread measureSpread(std::span<const Vec3> points) {
  Spread spread;
  spread.first_end = farthestFrom(points, widen(points[0]));
  spread.origin = widen(points[spread.first_end]);
  spread.last_end = farthestFrom(points, spread.origin);
  const Vec3d along = widen(points[spread.last_end]) - spread.origin;
  spread.length = norm(along);
  double magnitude = 0;
  for (const Vec3& point : points) magnitude = std::max(magnitude, norm(widen(point)));
  spread.tolerance = std::max(kFlatRatio * spread.length, kFloatNoise * magnitude);
  if (spread.length <= spread.tolerance) return spread;
  const Vec3d u = normalized(along);
  const auto across = [&](const Vec3d& p) {
    const Vec3d from = p - spread.origin;
    return from - u * dot(from, u);
  };
  const std::size_t side =
      greatest(points, [&](const Vec3d& p) { return dot(across(p), across(p)); });
  const Vec3d aside = across(widen(points[side]));
  spread.width = norm(aside);
  if (spread.width <= spread.tolerance) {
    const Axes around = axesAround(u);
    spread.frame = {u, around[0], around[1]};
    return spread;
  }
  const Vec3d v = normalized(aside);
  const Vec3d w = normalized(cross(u, v));
  spread.frame = {u, cross(w, u), w};
  spread.thickness = extentAlong(points, w);
  return spread;
}

/// The polygon of points that lie in a plane.
std::vector<HullCorner> planeCorners(std::span<const Vec3> points, const Spread& spread) {
  const auto flat = [&](const Vec3& point) {
    const Vec3d from = widen(point) - spread.origin;
    return Vec2d{dot(from, spread.frame[0]), dot(from, spread.frame[1])};
  };
  std::vector<Vec2d> in_plane;
  in_plane.reserve(points.size());
  for (const Vec3& point : points) in_plane.push_back(flat(point));
  std::vector<Vec2d> polygon;
  const std::vector<Vec2d> unsorted = in_plane;
  convexPolygon(in_plane, polygon);
  std::vector<HullCorner> corners;
  for (const Vec2d& corner : polygon) {
    const auto source = static_cast<std::size_t>(
        std::find(unsorted.begin(), unsorted.end(), corner) - unsorted.begin());
    corners.push_back({static_cast<std::uint32_t>(source), widen(points[source])});
  }
  return corners;
}

HullCorner cornerAt(std::span<const Vec3> points, std::size_t source) {
  return {static_cast<std::uint32_t>(source), widen(points[source])};
}

/// Copies Bullet's faces, with Bullet's numbering of corners.
void copyFaces(const btConvexHullComputer& bullet, ConvexHull& hull) {
  hull.faces.reserve(static_cast<std::size_t>(bullet.faces.size()));
  for (int face = 0; face < bullet.faces.size(); ++face) {
    const btConvexHullComputer::Edge* const first = &bullet.edges[bullet.faces[face]];
    std::vector<std::uint32_t> loop;
    const btConvexHullComputer::Edge* edge = first;
    do {
      loop.push_back(static_cast<std::uint32_t>(edge->getSourceVertex()));
      edge = edge->getNextEdgeOfFace();
    } while (edge != first);
    hull.faces.push_back(std::move(loop));
  }
}

void computeSolid(std::span<const Vec3> points, const Spread& spread, ConvexHull& hull) {
  const bool thin = spread.thickness < kThinRatio * spread.length;
  const Axes grid = thin ? spread.frame : kIdentityAxes;
  std::vector<double> coordinates;
  coordinates.reserve(3 * points.size());
  for (const Vec3& point : points) {
    const Vec3d from = widen(point) - spread.origin;
    for (const Vec3d& axis : grid) coordinates.push_back(dot(from, axis));
  }
  btConvexHullComputer bullet;
  bullet.compute(coordinates.data(), 3 * sizeof(double), static_cast<int>(points.size()), 0, 0);
  assert(bullet.vertices.size() == bullet.original_vertex_index.size());
  hull.corners.reserve(static_cast<std::size_t>(bullet.vertices.size()));
  for (int at = 0; at < bullet.vertices.size(); ++at) {
    const btVector3& rounded = bullet.vertices[at];
    const Vec3d place = grid[0] * static_cast<double>(rounded.x()) +
                        grid[1] * static_cast<double>(rounded.y()) +
                        grid[2] * static_cast<double>(rounded.z());
    hull.corners.push_back(
        {static_cast<std::uint32_t>(bullet.original_vertex_index[at]), spread.origin + place});
  }
  copyFaces(bullet, hull);
}

}  // namespace

ConvexHull convexHull(std::span<const Vec3> points) {
  assert(!points.empty());
  const Spread spread = measureSpread(points);
  ConvexHull hull;
  hull.frame = spread.frame;
  if (spread.length <= spread.tolerance) {
    hull.corners = {cornerAt(points, 0)};
  } else if (spread.width <= spread.tolerance) {
    hull.shape = HullShape::kLine;
    hull.corners = {cornerAt(points, spread.first_end), cornerAt(points, spread.last_end)};
  } else if (spread.thickness <= spread.tolerance) {
    hull.shape = HullShape::kPlane;
    hull.corners = planeCorners(points, spread);
  } else {
    hull.shape = HullShape::kSolid;
    computeSolid(points, spread, hull);
  }
  return hull;
}

}  // namespace galactic::bake::fit
