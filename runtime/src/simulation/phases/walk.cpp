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

/// The lane of `step.between` in which slides are looked at on their way.
constexpr std::size_t kSpareLane = kLanes;

/// Meters.
float smallestRadius(const SphereBatch& spheres) {
  float smallest = HUGE_VALF;
  for (const RadiusRange& range : spheres.ranges) {
    if (range.count > 0) smallest = std::min(smallest, range.radius);
  }
  return smallest;
}

/// Whether one of the spheres with a bit that do not count as ignored is smaller than `radius`.
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

/// One env's robot on its way. The lanes of `step.between` are places one after the other: lane 0
/// is where the robot is, the others are the next parts.
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
    // Of what it slid out of, rounding may tell the place when it is computed again.
    return isFree(step_, e_) ? Walk::kHindered : Walk::kNone;
  }

 private:
  enum class Progress : std::uint8_t { kFree, kSlid, kBlocked };

  /// A step in whose chunk this lane stands for the env: all lanes do. For the first envs of a
  /// batch the step begins below 0, as unsigned numbers wrap, and the lane added to that is the env
  /// again. So nobody may ask such a step for its first env.
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

  /// Puts the robot to where it is and to the next parts of its way.
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
        // An angle that came to the other end of its turn went the short way there.
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
    // A part may not climb on from where others of the step have climbed to.
    step_.between->floor(lane) = isInReach(under.height) ? under.floor : Floor::kDrops;
    heights_[lane] = under.height;
    places.y[lane] = under.height;
  }

  /// Whether one step may rise or drop to a height.
  [[nodiscard]] bool isInReach(float height) const {
    const GroundOptions& ground = step_.model.options.ground;
    return height <= *from_.y + ground.most_rise && height >= *from_.y - ground.most_drop;
  }

  /// Goes through the lanes as long as they are free; the first slide changes those after it.
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

  /// Whether no sphere passed through something as a lane slid `by`. A part is shorter than any
  /// radius; a slide may be longer than some.
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

  /// Of the spheres that findBlocked() found.
  [[nodiscard]] bool blocksSmallerThan(float radius) const {
    for (std::size_t n = 0; n < step_.model.groups.size(); ++n) {
      const std::uint64_t words = step_.between->seen(n / kLanes).blocked;
      const std::uint64_t blocked = words >> (n % kLanes * kLanes) & 0xffU;
      if (blocked != 0 && step_.model.groups[n].radius < radius) return true;
    }
    return false;
  }

  /// Whether a sphere of the robot that is smaller than `radius` is in a resting object, where the
  /// spare lane is.
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

  /// The same of what the robot holds, in the scene or in a resting object.
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
  /// Parts that are behind, and the lane that is there.
  std::size_t reached_ = 0;
  std::size_t lane_ = 0;
  Push slid_;
  /// Of the floor under each lane.
  std::array<float, kLanes> heights_{};
};

}  // namespace

Walk walkToCandidate(const ChunkStep& step, std::size_t e) noexcept {
  return Walker(step, e).run();
}

}  // namespace galactic::simulation
