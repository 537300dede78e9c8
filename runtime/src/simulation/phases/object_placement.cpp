#include "simulation/phases/object_placement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "support/lift.h"

namespace galactic::simulation {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
/// More than the rounding of a grid's heights, its quantum included, meters.
constexpr float kLeastClearance = 2e-4F;
/// By how much boxes and spheres may overlap because of rounding, meters.
constexpr float kRounding = 1e-5F;
/// Directions that are tried for one jitter; the second half of them are arbitrary.
constexpr int kDraws = 4;
/// A shorter vector gives no direction, meters.
constexpr float kLeastDirection = 1e-3F;

Pose raised(const Pose& pose, float height) {
  Pose result = pose;
  result.translation.y += height;
  return result;
}

/// The direction of a sum of horizontal vectors that does not depend on their order: floats are
/// added in fixed point. PushSum would not do: there, one vector cancels out many that point the
/// other way.
class DirectionSum {
 public:
  void add(float x, float z) {
    x_ += fixed(x);
    z_ += fixed(z);
  }

  /// The sum as a unit vector; none if the vectors cancel out.
  [[nodiscard]] std::optional<Vec3> direction() const {
    const Vec3 sum{static_cast<float>(x_) / kUnit, 0, static_cast<float>(z_) / kUnit};
    const float length = std::sqrt(dot(sum, sum));
    if (!(length > kLeastDirection)) return std::nullopt;
    return sum * (1 / length);
  }

 private:
  static constexpr float kUnit = 0x1p20F;
  /// Longer vectors, and NaN, are ignored.
  static constexpr float kLongest = 1000;

  static std::int64_t fixed(float value) {
    return std::fabs(value) < kLongest ? std::llrint(value * kUnit) : 0;
  }

  std::int64_t x_ = 0;
  std::int64_t z_ = 0;
};

/// Tries one object among its obstacles at one candidate pose after another.
class Candidate {
 public:
  Candidate(const Obstacles& obstacles, const ObjectModel& object, const PlacementOptions& options,
            PlacementScratch& scratch)
      : scene_(obstacles.scene),
        objects_(obstacles.objects),
        object_(object),
        scratch_(scratch),
        most_lift_(options.most_lift),
        clearance_(std::max(options.clearance, kLeastClearance)) {}

  /// Where the object comes to rest when released at `pose`; none if it finds no place.
  [[nodiscard]] std::optional<Pose> settle(const Pose& pose) {
    const std::optional<float> lift = findLift(pose);
    if (!lift) return std::nullopt;
    const float fall = findFall();
    if (!(fall < kInfinity)) return std::nullopt;
    const Pose landed = raised(pose, *lift - fall + clearance_);
    moveTo(landed);
    if (!isFree()) return std::nullopt;
    return landed;
  }

  /// The direction away from what blocked the last candidate.
  [[nodiscard]] std::optional<Vec3> wayOut() const {
    const std::optional<Vec3> away = from_objects_.direction();
    return away ? away : from_scene_.direction();
  }

 private:
  void moveTo(const Pose& pose) {
    batch_ = holdSpheres(object_, pose, scratch_.spheres);
    box_ = restingBox(object_.box, pose);
    // Boxes may overlap by the clearance, so that neighbors that touch do not block each other.
    Vec3& half = box_.half_extents;
    half = {std::max(half.x - clearance_, 0.0F), std::max(half.y - clearance_, 0.0F),
            std::max(half.z - clearance_, 0.0F)};
    querySpheres();
  }

  /// Asks the scene about all spheres.
  void querySpheres() {
    for (const RadiusRange& range : batch_.ranges) {
      const auto part = [&range](auto& values) {
        return std::span(values).subspan(range.first, range.count);
      };
      scene_.grids()[range.radius_index].contact(
          {{batch_.x + range.first, range.count},
           {batch_.y + range.first, range.count},
           {batch_.z + range.first, range.count}},
          {part(scratch_.clearance), part(scratch_.down), part(scratch_.up)});
    }
  }

  /// Calls `visit` with each sphere's index, center and range.
  template <class Visit>
  void forEachSphere(const Visit& visit) const {
    for (const RadiusRange& range : batch_.ranges) {
      for (std::size_t n = range.first; n < range.first + range.count; ++n) {
        visit(n, Vec3{batch_.x[n], batch_.y[n], batch_.z[n]}, range);
      }
    }
  }

  /// Calls `visit` with each resting box that lies under, in or over the object's bounds.
  template <class Visit>
  void forEachObjectNear(const Visit& visit) const {
    // Spheres may stick out of the box.
    const float around = objects_.largestRadius() + clearance_;
    const Vec3 own = halfBounds(box_);
    for (std::uint32_t index = 0; index < objects_.capacity(); ++index) {
      if (!objects_.isResting(index)) continue;
      const RestingBox& other = objects_.box(index);
      const Vec3 half = halfBounds(other);
      if (std::fabs(other.center.x - box_.center.x) > half.x + own.x + around) continue;
      if (std::fabs(other.center.z - box_.center.z) > half.z + own.z + around) continue;
      visit(other);
    }
  }

  /// Lifts the object from `pose` to the lowest height at which it is free, and returns the lift;
  /// none if that exceeds the largest allowed lift, in which case the pushes are set.
  [[nodiscard]] std::optional<float> findLift(const Pose& pose) {
    float lift = 0;
    for (int n = 0; n < detail::kMostLifts; ++n) {
      moveTo(raised(pose, lift));
      from_scene_ = {};
      from_objects_ = {};
      const float more =
          std::max(liftOutOfScene(most_lift_ - lift), liftOutOfObjects(most_lift_ - lift));
      if (more == 0) return lift;
      lift += more + detail::kLiftNudge;
      if (!(lift <= most_lift_)) return std::nullopt;
    }
    return std::nullopt;
  }

  /// How far the object has to rise for its spheres to be free of the scene. Spheres that need more
  /// than `limit` add a push.
  [[nodiscard]] float liftOutOfScene(float limit) {
    float most = 0;
    forEachSphere([&](std::size_t n, const Vec3& center, const RadiusRange& range) {
      if (scratch_.clearance[n] == Clearance::kFree) return;
      const float lift = detail::liftOutOf(scene_.grids()[range.radius_index], center);
      // A height that is free in the column may not be free in the batched query, which counts in
      // quanta.
      most = std::max(most, std::max(lift, detail::kLiftNudge));
      if (lift > limit) from_scene_.add(box_.center.x - center.x, box_.center.z - center.z);
    });
    return most;
  }

  /// The same for resting objects.
  [[nodiscard]] float liftOutOfObjects(float limit) {
    float most = 0;
    forEachObjectNear([&](const RestingBox& other) {
      float lift = 0;
      forEachSphere([&](std::size_t, const Vec3& center, const RadiusRange& range) {
        if (!overlaps(other, center, range.radius)) return;
        const auto heights = overlapHeights(other, center.x, center.z, range.radius);
        if (heights) lift = std::max(lift, heights->hi - center.y);
      });
      const std::optional<Span> shifts = overlapShifts(box_, other);
      if (shifts && shifts->lo < -kRounding && shifts->hi > kRounding) {
        lift = std::max(lift, shifts->hi);
      }
      most = std::max(most, lift);
      if (lift > limit) pushFrom(other);
    });
    return most;
  }

  void pushFrom(const RestingBox& other) {
    const Vec3 away{box_.center.x - other.center.x, 0, box_.center.z - other.center.z};
    const float length = std::sqrt(dot(away, away));
    if (length > kLeastDirection) from_objects_.add(away.x / length, away.z / length);
  }

  /// How far the object, which is free, can sink; infinity if nothing is under it.
  [[nodiscard]] float findFall() const {
    float least = kInfinity;
    forEachSphere([&](std::size_t n, const Vec3& center, const RadiusRange& range) {
      const float down = scratch_.down[n];
      const ColumnGrid& grid = scene_.grids()[range.radius_index];
      if (detail::hasFloor(grid, center.y - down)) least = std::min(least, down);
      least = std::min(least, objects_.fall(center, range.radius));
    });
    forEachObjectNear([&](const RestingBox& other) {
      const std::optional<Span> shifts = overlapShifts(box_, other);
      if (shifts && shifts->hi <= kRounding) least = std::min(least, std::max(-shifts->hi, 0.0F));
    });
    return least;
  }

  [[nodiscard]] bool isFree() const {
    bool free = !objects_.touches(batch_);
    forEachSphere([&](std::size_t n, const Vec3&, const RadiusRange&) {
      free = free && scratch_.clearance[n] == Clearance::kFree;
    });
    forEachObjectNear([&](const RestingBox& other) {
      const std::optional<Span> shifts = overlapShifts(box_, other);
      free = free && !(shifts && shifts->lo < -kRounding && shifts->hi > kRounding);
    });
    return free;
  }

  /// First member, because it is aligned to a cache line.
  RestingBox box_;
  const Scene& scene_;
  const RestingObjects& objects_;
  const ObjectModel& object_;
  PlacementScratch& scratch_;
  float most_lift_;
  float clearance_;
  SphereBatch batch_;
  DirectionSum from_scene_;
  DirectionSum from_objects_;
};

/// A random horizontal unit vector: `way` turned by up to `spread`, or any direction if there is no
/// way.
Vec3 drawDirection(const std::optional<Vec3>& way, float spread, RandomStream& random) {
  const float share = 2 * random.unit() - 1;
  // Double precision, because the last digit of the float functions differs between compilers.
  const double range = way ? static_cast<double>(spread) : std::numbers::pi;
  const double angle = range * static_cast<double>(share);
  const auto cosine = static_cast<float>(std::cos(angle));
  const auto sine = static_cast<float>(std::sin(angle));
  const Vec3 from = way.value_or(Vec3{1, 0, 0});
  return {cosine * from.x - sine * from.z, 0, sine * from.x + cosine * from.z};
}

/// Whether a sphere of the smallest radius can move straight from `from` by `step`: the jitter must
/// not jump through a wall.
bool isPathFree(const Scene& scene, const Vec3& from, const Vec3& step) {
  const ColumnGrid& grid = scene.grids().front();
  const float samples = std::ceil(std::sqrt(dot(step, step)) / grid.radius());
  if (!(samples < 0x1p20F)) return false;
  const auto count = static_cast<std::uint32_t>(samples);
  for (std::uint32_t n = 1; n <= count; ++n) {
    const Vec3 at = from + step * (static_cast<float>(n) / samples);
    if (grid.clearance(at) != Clearance::kFree) return false;
  }
  return true;
}

}  // namespace

PlacementScratch::PlacementScratch(std::size_t most_spheres, std::span<const float> radii)
    : spheres(most_spheres, radii) {
  const std::size_t room = paddedToLanes(most_spheres) + kLanes * radii.size();
  clearance.resize(room);
  down.resize(room);
  up.resize(room);
}

Landing placeObject(const Obstacles& obstacles, const ObjectModel& object, const Pose& released,
                    RandomStream& random, const PlacementOptions& options,
                    PlacementScratch& scratch) noexcept {
  Candidate candidate(obstacles, object, options, scratch);
  const Vec3& half = object.box.half_extents;
  const float longest = options.jitter * 2 * std::sqrt(dot(half, half));
  Pose pose = released;
  bool is_new = true;
  for (std::uint32_t attempt = 1; attempt <= options.attempts; ++attempt) {
    if (is_new) {
      const std::optional<Pose> landed = candidate.settle(pose);
      if (landed) return {*landed, true, attempt};
    }
    if (attempt == options.attempts) break;
    is_new = false;
    const Vec3 center = pose * object.box.pose.translation;
    for (int draw = 0; draw < kDraws && !is_new; ++draw) {
      const auto way = draw < kDraws / 2 ? candidate.wayOut() : std::nullopt;
      const Vec3 direction = drawDirection(way, options.direction_spread, random);
      const Vec3 step = direction * (longest * (0.5F + 0.5F * random.unit()));
      if (!isPathFree(obstacles.scene, center, step)) continue;
      pose.translation = pose.translation + step;
      is_new = true;
    }
  }
  return {released, false, options.attempts};
}

}  // namespace galactic::simulation
