#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "fit/box_axes.h"
#include "fit/convex_hull.h"
#include "fit/simplex_search.h"

namespace galactic::bake::fit {
namespace {

/// The search uses the points that are extremal along this many directions. The last steps use all
/// corners of the hull.
constexpr std::size_t kSearchDirections = 300;
/// Number of different candidates that are improved.
constexpr std::size_t kImprovedCandidates = 8;
/// Normals, or axes of boxes, closer than this (cosine, 0.26 and 3.1 degrees) count as the same.
constexpr double kSameNormal = 1 - 1e-5;
constexpr double kSameBox = 0.9985;

/// The points that reach farthest along evenly spread directions, in their original order.
std::vector<Vec3> extremalPoints(std::span<const Vec3> points) {
  std::vector<bool> chosen(points.size(), false);
  for (std::size_t index = 0; index < kSearchDirections; ++index) {
    const Vec3d direction = evenDirection(index, kSearchDirections);
    std::size_t best = 0;
    double reach = dot(widen(points[0]), direction);
    for (std::size_t at = 1; at < points.size(); ++at) {
      const double here = dot(widen(points[at]), direction);
      if (here <= reach) continue;
      reach = here;
      best = at;
    }
    chosen[best] = true;
  }
  std::vector<Vec3> extremal;
  for (std::size_t at = 0; at < points.size(); ++at) {
    if (chosen[at]) extremal.push_back(points[at]);
  }
  return extremal;
}

std::vector<Vec3> cornersOf(const ConvexHull& hull, std::span<const Vec3> points) {
  std::vector<Vec3> corners;
  corners.reserve(hull.corners.size());
  for (const HullCorner& corner : hull.corners) corners.push_back(points[corner.source]);
  return corners;
}

/// The distinct normals of the hull's faces. Opposite normals count as one.
std::vector<Vec3d> faceNormals(const ConvexHull& hull) {
  std::vector<Vec3d> normals;
  for (const std::vector<std::uint32_t>& face : hull.faces) {
    Vec3d area;
    for (std::size_t at = 2; at < face.size(); ++at) {
      const Vec3d& origin = hull.corners[face[0]].rounded;
      area = area + cross(hull.corners[face[at - 1]].rounded - origin,
                          hull.corners[face[at]].rounded - origin);
    }
    if (norm(area) <= 0) continue;
    const Vec3d normal = normalized(area);
    const bool known = std::any_of(normals.begin(), normals.end(), [&](const Vec3d& other) {
      return std::abs(dot(other, normal)) > kSameNormal;
    });
    if (!known) normals.push_back(normal);
  }
  return normals;
}

bool sameBox(const Axes& a, const Axes& b) {
  return std::all_of(a.begin(), a.end(), [&](const Vec3d& axis) {
    return std::any_of(b.begin(), b.end(),
                       [&](const Vec3d& other) { return std::abs(dot(axis, other)) > kSameBox; });
  });
}

/// The best of the candidates, no two of them nearly the same.
std::vector<BoxCandidate> bestDifferent(std::vector<BoxCandidate> candidates) {
  std::stable_sort(
      candidates.begin(), candidates.end(),
      [](const BoxCandidate& a, const BoxCandidate& b) { return a.volume < b.volume; });
  std::vector<BoxCandidate> chosen;
  for (const BoxCandidate& candidate : candidates) {
    if (chosen.size() == kImprovedCandidates) break;
    const bool known = std::any_of(chosen.begin(), chosen.end(), [&](const BoxCandidate& other) {
      return sameBox(candidate.axes, other.axes);
    });
    if (!known) chosen.push_back(candidate);
  }
  return chosen;
}

/// Searches rotations near a box with Nelder and Mead's simplex; its size is in radians.
BoxCandidate turnToBetter(const PointSet& points, const BoxCandidate& box, double min_side,
                          const SimplexOptions& options) {
  const auto axes_at = [&](const Vec3d& turn) {
    return Axes{rotated(box.axes[0], turn), rotated(box.axes[1], turn), rotated(box.axes[2], turn)};
  };
  const SimplexResult found = searchSimplex(
      [&](const Vec3d& turn) { return boxVolume(points, axes_at(turn), min_side); }, options);
  if (found.value >= box.volume) return box;
  return {axes_at(found.place), found.value};
}

std::vector<BoxCandidate> seedBoxes(const PointSet& points, const ConvexHull& hull,
                                    double min_side) {
  std::vector<BoxCandidate> seeds;
  for (const Axes& axes : {kIdentityAxes, principalAxes(points), ditoAxes(points), hull.frame}) {
    seeds.push_back({axes, boxVolume(points, axes, min_side)});
  }
  FixedAxisCalipers calipers(points, min_side);
  for (const Vec3d& axis : kIdentityAxes) seeds.push_back(calipers.bestAround(axis));
  seeds.push_back(calipers.bestAround(hull.frame[2]));
  for (const Vec3d& normal : faceNormals(hull)) seeds.push_back(calipers.bestAround(normal));
  return seeds;
}

}  // namespace

Axes minimumBoxAxes(std::span<const Vec3> points, double min_side) {
  const ConvexHull whole = convexHull(points);
  const std::vector<Vec3> corners = cornersOf(whole, points);
  const bool reduce = corners.size() > kSearchDirections && whole.shape == HullShape::kSolid;
  const std::vector<Vec3> few = reduce ? extremalPoints(corners) : corners;
  const PointSet searched = pointSet(few);
  std::vector<BoxCandidate> seeds = seedBoxes(searched, reduce ? convexHull(few) : whole, min_side);
  FixedAxisCalipers calipers(searched, min_side);
  BoxCandidate best = seeds.front();
  for (const BoxCandidate& seed : bestDifferent(std::move(seeds))) {
    BoxCandidate box = calipers.improve(seed, 12);
    for (const double radians : {0.1, 0.02}) {
      box = turnToBetter(searched, box, min_side, {.size = radians, .max_steps = 120});
      box = calipers.improve(box, 4);
    }
    if (box.volume < best.volume) best = box;
  }
  if (!reduce) return best.axes;
  const PointSet all = pointSet(corners);
  best.volume = boxVolume(all, best.axes, min_side);
  best = FixedAxisCalipers(all, min_side).improve(best, 3);
  return turnToBetter(all, best, min_side, {.size = 0.005, .max_steps = 60}).axes;
}

}  // namespace galactic::bake::fit
