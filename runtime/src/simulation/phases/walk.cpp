#include "simulation/phases/walk.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "simulation/phases/contacts.h"
#include "simulation/phases/move.h"
#include "simulation/phases/slide.h"

namespace galactic::simulation {
namespace {

/// The lane of `step.between` in which places along a slide are checked.
constexpr std::size_t kSpareLane = kLanes;

/// The smallest radius of any sphere, meters.
float smallestRadius(const SphereBatch& spheres) {
  float smallest = HUGE_VALF;
  for (const RadiusRange& range : spheres.ranges) {
    if (range.count > 0) smallest = std::min(smallest, range.radius);
  }
  return smallest;
}

/// Whether any sphere that has its bit set and is not ignored is smaller than `radius`.
bool anySmaller(const SphereBatch& spheres, std::span<const std::uint64_t> bits,
                IgnoredSpheres ignored, float radius) {
  for (const RadiusRange& range : spheres.ranges) {
    if (range.radius >= radius) continue;
    for (std::uint32_t n = range.first; n < range.first + range.count; ++n) {
      if (hasBit(bits, n) && !isIgnored(ignored, n)) return true;
    }
  }
  return false;
}

/// Walks one env's robot along its way. The lanes of `step.between` are successive places: lane 0
/// is where the robot is, the others are the ends of the next parts.
class Walker {
 public:
  Walker(const ChunkStep& step, std::size_t e)
      : step_(step),
        e_(e),
        scene_(step.model.scenes[step.state.env(step.first + e).scene]),
        from_(step.state.poses(step.first + e)),
        to_(step.chunk.candidates(e)),
        turn_(wrappedAngle(*to_.yaw - *from_.yaw)) {
    heights_[0] = *from_.y;
    placeNext();
    cutInParts();
  }

  Walk run() {
    Progress progress = Progress::kFree;
    while (progress != Progress::kBlocked && reached_ < parts_) {
      placeNext();
      progress = goOn();
    }
    const bool has_slid = slid_.x != 0 || slid_.z != 0;
    if (reached_ == parts_ && !has_slid && isFree(step_, e_)) return Walk::kStraight;
    if (reached_ == 0) return Walk::kNone;
    step_.chunk.takeOver(e_, *step_.between, lane_);
    // After a slide, rounding may put the robot back into the obstacle when the place is computed
    // again.
    return isFree(step_, e_) ? Walk::kHindered : Walk::kNone;
  }

 private:
  enum class Progress : std::uint8_t { kFree, kSlid, kBlocked };

  /// A step in whose chunk lane `lane` stands for this env. For the first envs of a batch, `first`
  /// wraps below 0 and adding the lane wraps it back to the env. So no code may use such a step's
  /// `first` without adding the lane.
  [[nodiscard]] ChunkStep at(std::size_t lane) const {
    return {step_.model, step_.state, *step_.between, step_.first + e_ - lane};
  }

  void cutInParts() {
    const SphereBatch robot = step_.between->spheres(0);
    float farthest = farthestMove(robot, step_.chunk.spheres(e_));
    smallest_radius_ = smallestRadius(robot);
    if (step_.state.env(step_.first + e_).held >= 0) {
      const SphereBatch held = heldSpheres(at(0), 0);
      farthest = std::max(farthest, farthestMove(held, heldSpheres(step_, e_)));
      smallest_radius_ = std::min(smallest_radius_, smallestRadius(held));
    }
    parts_ = std::max<std::size_t>(1, static_cast<std::size_t>(std::ceil(farthest)));
  }

  /// Places the robot at its current place (lane 0) and at the ends of the next parts.
  void placeNext() {
    const PoseArrays places = step_.between->candidates(0);
    heights_[0] = heights_[lane_];
    lane_ = 0;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const std::size_t part = std::min(reached_ + lane, parts_);
      const float share = static_cast<float>(part) / static_cast<float>(parts_);
      const auto between = [share](float from, float to) { return from + share * (to - from); };
      places.x[lane] = between(*from_.x, *to_.x) + slid_.x;
      places.z[lane] = between(*from_.z, *to_.z) + slid_.z;
      places.yaw[lane] = wrappedAngle(*from_.yaw + share * turn_);
      for (std::size_t v = 0; v < step_.model.variableCount(); ++v) {
        const float from = from_.variables[v * from_.stride];
        const float to = to_.variables[v * to_.stride];
        // An angle that wraps goes the shorter way round.
        places.variables[v * places.stride + lane] =
            step_.model.motion.variables[v].wraps
                ? wrappedAngle(between(from, from + wrappedAngle(to - from)))
                : between(from, to);
      }
      putOnFloor(places, lane);
    }
    step_.model.kernels.place(step_.model.tables,
                              {.pose = places, .body = step_.between->bodies(0)});
  }

  void putOnFloor(const PoseArrays& places, std::size_t lane) {
    const float from = heights_[lane == 0 ? 0 : lane - 1];
    const FloorUnder under =
        floorUnder(scene_, {places.x[lane], from, places.z[lane]}, step_.model.options.ground);
    // All parts of a step together may not climb or drop more than one step may.
    step_.between->floor(lane) = isInReach(under.height) ? under.floor : Floor::kDrops;
    heights_[lane] = under.height;
    places.y[lane] = under.height;
  }

  /// Whether the whole step may rise or drop to a height.
  [[nodiscard]] bool isInReach(float height) const {
    const GroundOptions& ground = step_.model.options.ground;
    return height <= *from_.y + ground.most_rise && height >= *from_.y - ground.most_drop;
  }

  /// Advances through the lanes while they are free; stops after a slide, which changes the lanes
  /// behind it.
  Progress goOn() {
    for (std::size_t lane = 1; lane < kLanes && reached_ < parts_; ++lane) {
      const Hindrance met = hindranceOf(at(lane), lane);
      if (met != Hindrance::kNone && !slide(lane, met)) return Progress::kBlocked;
      lane_ = lane;
      ++reached_;
      if (met != Hindrance::kNone) return Progress::kSlid;
    }
    return Progress::kFree;
  }

  bool slide(std::size_t lane, Hindrance met) {
    const Vec3 before = step_.between->base(lane);
    if (!slideClear(at(lane), lane, met)) return false;
    const Vec3 after = step_.between->base(lane);
    const Push by{after.x - before.x, after.z - before.z};
    if (!isInReach(after.y) || !slidThroughNothing(lane, by)) return false;
    slid_ = {slid_.x + by.x, slid_.z + by.z};
    heights_[lane] = after.y;
    return true;
  }

  /// Whether no sphere passed through something when a lane slid `by`. No sphere moves further than
  /// its radius in a part, but a slide may be longer than some radii.
  [[nodiscard]] bool slidThroughNothing(std::size_t lane, const Push& by) const {
    const float length = std::sqrt(by.x * by.x + by.z * by.z);
    const float looks = std::ceil(length / smallest_radius_);
    const Vec3 last = step_.between->base(lane_);
    const Vec3 here = step_.between->base(lane);
    const Vec3 back{(last.x - here.x) / looks, 0, (last.z - here.z) / looks};
    step_.between->takeOver(kSpareLane, *step_.between, lane);
    for (float n = 1; n < looks; ++n) {
      step_.between->shift(kSpareLane, back);
      const ChunkStep there = at(kSpareLane);
      if (findBlocked(there, kSpareLane) && blocksSmallerThan(length)) return false;
      if (objectsMeet(there, length) || heldMeets(there, length)) return false;
    }
    return true;
  }

  /// Whether findBlocked() found a sphere smaller than `radius`.
  [[nodiscard]] bool blocksSmallerThan(float radius) const {
    for (std::size_t n = 0; n < step_.model.groups.size(); ++n) {
      const std::uint64_t words = step_.between->seen(n / kLanes).blocked;
      const std::uint64_t blocked = words >> (n % kLanes * kLanes) & 0xffU;
      if (blocked != 0 && step_.model.groups[n].radius < radius) return true;
    }
    return false;
  }

  /// Whether a sphere of the robot in the spare lane that is smaller than `radius` penetrates a
  /// resting object.
  [[nodiscard]] bool objectsMeet(const ChunkStep& there, float radius) const {
    const RestingObjects& objects = step_.state.resting(step_.first + e_);
    if (!objects.mayTouch(there.chunk.extents(kSpareLane))) return false;
    const SphereBatch spheres = there.chunk.spheres(kSpareLane);
    const std::span<std::uint64_t> bits = there.chunk.bodyBits();
    const bool meets = withoutLeft(there, kSpareLane, [&] {
      return penetratingObjects(objects, spheres, bits) && anySmaller(spheres, bits, {}, radius);
    });
    if (meets) return true;
    bool meets_left = false;
    forEachLeft(there, kSpareLane, [&](std::uint32_t object) {
      const IgnoredSpheres leaving = step_.state.leaving(step_.first + e_, object);
      meets_left = meets_left || (overlapping(objects.box(object), spheres, bits) &&
                                  anySmaller(spheres, bits, leaving, radius));
    });
    return meets_left;
  }

  /// The same for the held object, against the scene and the resting objects.
  [[nodiscard]] bool heldMeets(const ChunkStep& there, float radius) const {
    if (step_.state.env(step_.first + e_).held < 0) return false;
    lookAtHeld(there, kSpareLane);
    if (heldIsSurelyFree(there, kSpareLane)) return false;
    const SphereBatch spheres = heldSpheres(there, kSpareLane);
    const std::span<std::uint64_t> bits = there.chunk.heldBits();
    penetrating(obstaclesOf(there, kSpareLane), spheres, there.chunk.collision(), bits);
    return anySmaller(spheres, bits, step_.state.ignored(step_.first + e_), radius);
  }

  const ChunkStep& step_;
  std::size_t e_;
  const Scene& scene_;
  PoseArrays from_;
  PoseArrays to_;
  float turn_;
  std::size_t parts_ = kLanes;
  float smallest_radius_ = 0;
  /// The number of finished parts, and the lane at the end of the last one.
  std::size_t reached_ = 0;
  std::size_t lane_ = 0;
  Push slid_;
  /// The heights of the floor under each lane.
  std::array<float, kLanes> heights_{};
};

}  // namespace

Walk walkToCandidate(const ChunkStep& step, std::size_t e) noexcept {
  return Walker(step, e).run();
}

}  // namespace galactic::simulation
