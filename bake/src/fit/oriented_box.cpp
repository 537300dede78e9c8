#include "galactic/bake/oriented_box.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <vector>

#include "fit/axes.h"
#include "fit/box_axes.h"
#include "fit/convex_hull.h"
#include "fit/rotation.h"

namespace galactic::bake {
namespace {

using fit::Axes;
using fit::PointSet;

constexpr double kMinSide = 2 * static_cast<double>(kMinHalfExtent);
/// Added to each half extent, so that points are inside whatever order of float operations a reader
/// uses: a length in meters, and a share of the greatest coordinate (eight roundings).
constexpr double kPadding = 1e-6;
constexpr double kRelativePadding = 8 * 6e-8;

/// How far points reach from the center along each axis, in the float arithmetic that a reader
/// uses.
std::array<float, 3> floatReach(const PointSet& points, const Pose& object_from_box) {
  const Pose box_from_object = inverse(object_from_box);
  std::array<float, 3> reach{};
  for (std::size_t at = 0; at < points.size(); ++at) {
    const Vec3 local = box_from_object * narrow(points[at]);
    reach[0] = std::max(reach[0], std::abs(local.x));
    reach[1] = std::max(reach[1], std::abs(local.y));
    reach[2] = std::max(reach[2], std::abs(local.z));
  }
  return reach;
}

/// The box around `points` along `axes`, rounded to floats and grown until every point is inside in
/// exact and in float arithmetic.
OrientedBox boxAround(const PointSet& points, const Axes& axes) {
  OrientedBox box;
  box.pose.rotation = fit::quaternionOf(fit::nearestEquivalent(axes));
  // From here on, use the axes of the rounded rotation.
  const Axes stored = fit::axesOf(box.pose.rotation);
  std::array<fit::Interval, 3> sides;
  Vec3d center;
  double magnitude = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    sides[axis] = fit::intervalAlong(points, stored[axis]);
    center = center + stored[axis] * ((sides[axis].lo + sides[axis].hi) / 2);
    magnitude = std::max({magnitude, std::abs(sides[axis].lo), std::abs(sides[axis].hi)});
  }
  box.pose.translation = narrow(center);
  const Vec3d origin = widen(box.pose.translation);
  const std::array<float, 3> in_floats = floatReach(points, box.pose);
  std::array<float, 3> half{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double middle = dot(origin, stored[axis]);
    const double reach = std::max(
        {sides[axis].hi - middle, middle - sides[axis].lo, static_cast<double>(in_floats[axis])});
    half[axis] = std::max(static_cast<float>(reach + kPadding + kRelativePadding * magnitude),
                          kMinHalfExtent);
  }
  box.half_extents = {half[0], half[1], half[2]};
  return box;
}

double volumeOf(const OrientedBox& box) {
  const Vec3d half = widen(box.half_extents);
  return 8 * half.x * half.y * half.z;
}

/// Y stays up; the horizontal sides are those of the rectangle of least area.
Axes yawAxes(const PointSet& points) {
  const Axes around = fit::FixedAxisCalipers(points, kMinSide).bestAround({0, 1, 0}).axes;
  return {around[1], around[2], around[0]};
}

/// The smaller of two boxes; the first of equal ones.
const OrientedBox& smaller(const OrientedBox& a, const OrientedBox& b) {
  return volumeOf(b) < volumeOf(a) ? b : a;
}

}  // namespace

BoxFitResult fitOrientedBox(std::span<const Vec3> points, BoxFit fit) {
  assert(!points.empty());
  const std::vector<Vec3> unique = fit::uniquePoints(points);
  const PointSet set = fit::pointSet(unique);
  const OrientedBox aligned = boxAround(set, fit::kIdentityAxes);
  const OrientedBox principal = boxAround(set, fit::principalAxes(set));
  BoxFitResult result;
  result.axis_aligned_volume = volumeOf(aligned);
  result.pca_volume = volumeOf(principal);
  result.used = fit;
  result.box = aligned;
  if (fit != BoxFit::kAxisAligned) {
    const OrientedBox yaw = smaller(aligned, boxAround(set, yawAxes(set)));
    const OrientedBox searched = boxAround(set, fit::minimumBoxAxes(unique, kMinSide));
    const OrientedBox least = smaller(yaw, smaller(principal, searched));
    const bool saves = volumeOf(least) < volumeOf(yaw) * (1 - kMinimumBoxSaving);
    result.used = fit == BoxFit::kMinimum || saves ? BoxFit::kMinimum : BoxFit::kYaw;
    result.box = result.used == BoxFit::kMinimum ? least : yaw;
  }
  result.volume = volumeOf(result.box);
  return result;
}

}  // namespace galactic::bake
