#include "views/camera_sight.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "column_grid/free_way.h"

namespace galactic {
namespace {

/// The line is free if a ball of this radius can move along it: the near plane of an image is about
/// this wide. Without a grid for it, a smaller ball has to do.
constexpr float kRadius = 0.05F;
/// How many turns are tried to either side, up to half a turn.
constexpr int kTurns = 12;
constexpr float kTurn = std::numbers::pi_v<float> / kTurns;
/// Half a turn is as bad as coming nearer by this fraction of the distance.
constexpr float kPriceOfHalfATurn = 0.5F;
/// The camera is also tried up to kRises steps of kRise higher, as an angle. Each step is as bad as
/// coming nearer by the fraction kPriceOfARise.
constexpr int kRises = 2;
constexpr float kRise = std::numbers::pi_v<float> / 9;
constexpr float kPriceOfARise = 0.1F;
/// Lower targets are tried too: kLower meters below each other, down to kLowestTarget above the
/// base.
constexpr float kLower = 0.15F;
constexpr float kPriceOfMetersLower = 0.4F;
constexpr float kLowestTarget = 0.1F;

const ColumnGrid& gridFor(const Scene& scene) {
  const auto wide = std::find_if(scene.grids().begin(), scene.grids().end(),
                                 [](const ColumnGrid& grid) { return grid.radius() >= kRadius; });
  return wide != scene.grids().end() ? *wide : scene.grids().back();
}

/// The camera, turned about the vertical line through `pivot`.
RigidTransform turned(const RigidTransform& from, const Vec3& pivot, float angle) {
  const float c = std::cos(angle);
  const float s = std::sin(angle);
  const auto turn = [&](const Vec3& v) { return Vec3{c * v.x + s * v.z, v.y, c * v.z - s * v.x}; };
  return {turn(from.x_axis), turn(from.y_axis), turn(from.z_axis),
          pivot + turn(from.origin - pivot)};
}

/// The camera, moved upwards by `angle` on a circle about `pivot`, which is on its axis.
RigidTransform raised(const RigidTransform& from, const Vec3& pivot, float angle) {
  const float c = std::cos(angle);
  const float s = std::sin(angle);
  const Vec3 away = from.origin - pivot;
  const Vec3 ahead = from.x_axis * c - from.y_axis * s;
  return {ahead, from.y_axis * c + from.x_axis * s, from.z_axis,
          pivot - ahead * std::sqrt(dot(away, away))};
}

/// Which fraction of the line from `from` to `to` is free before the first obstacle, 0 to 1.
float freeShare(const ColumnGrid& grid, const Vec3& from, const Vec3& to) {
  const Vec3 way = to - from;
  const double length = detail::lengthOf(way);
  if (length == 0) return 1;
  if (!std::isfinite(length)) return 0;
  const auto free = detail::freeWay(grid, detail::straightLine(from, way, length));
  return static_cast<float>(free.length / length);
}

/// The point on the camera's axis that is nearest to the vertical line through `base`.
Vec3 targetOf(const RigidTransform& camera, const Vec3& base) {
  const Vec3& axis = camera.x_axis;
  const float level = axis.x * axis.x + axis.z * axis.z;
  const Vec3 way = base - camera.origin;
  return camera.origin + axis * (level > 0 ? (way.x * axis.x + way.z * axis.z) / level : 0);
}

}  // namespace

SightLine inSight(const Scene& scene, const Vec3& base, const RigidTransform& wanted) noexcept {
  const ColumnGrid& grid = gridFor(scene);
  const Vec3 highest = targetOf(wanted, base);
  SightLine found{wanted, highest};
  if (dot(highest - wanted.origin, wanted.x_axis) < 0) return found;
  float best = -1;
  const auto consider = [&](const RigidTransform& start, const Vec3& target, float price) {
    for (int n = 0; n < 2 * kTurns; ++n) {
      // 0, then alternately to the left and to the right.
      const int turns = (n % 2 == 0 ? 1 : -1) * ((n + 1) / 2);
      const float whole = price + kPriceOfHalfATurn * std::abs(static_cast<float>(turns)) / kTurns;
      if (1 - whole <= best) return;
      RigidTransform camera = turned(start, target, static_cast<float>(turns) * kTurn);
      const float share = freeShare(grid, target, camera.origin);
      if (share - whole <= best) continue;
      best = share - whole;
      camera.origin = target + (camera.origin - target) * share;
      found = {camera, target};
    }
  };
  float lowered = 0;
  // If a number is NaN, the first condition ends the loop. The second ends it once no lower target
  // can be better: the target of a camera that looks up can be arbitrarily high.
  while (highest.y - lowered >= base.y + kLowestTarget &&
         1 - kPriceOfMetersLower * lowered > best) {
    const Vec3 target = highest - Vec3{0, lowered, 0};
    RigidTransform start = wanted;
    start.origin.y -= lowered;
    const float price = kPriceOfMetersLower * lowered;
    for (int rise = 0; rise <= kRises; ++rise) {
      if (grid.clearance(target) != Clearance::kFree) break;
      const float angle = static_cast<float>(rise) * kRise;
      consider(raised(start, target, angle), target,
               price + kPriceOfARise * static_cast<float>(rise));
    }
    lowered += kLower;
  }
  return found;
}

}  // namespace galactic
