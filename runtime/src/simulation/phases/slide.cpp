#include "simulation/phases/slide.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>

#include "simulation/phases/move.h"
#include "simulation/phases/scene_exit.h"

namespace galactic::simulation {
namespace {

/// Moves the candidate over the floor. Returns whether its height stays the same.
bool moveBase(const ChunkStep& step, std::size_t e, const Push& by) {
  const float floor_before = *step.state.poses(step.first + e).y;
  const Vec3 base = step.chunk.base(e);
  const FloorUnder under = floorUnder(step, e, {base.x + by.x, floor_before, base.z + by.z});
  step.chunk.floor(e) = under.floor;
  step.chunk.shift(e, {by.x, under.height - base.y, by.z});
  return under.height == base.y;
}

/// Slides one candidate along its obstacles: makes the shortest move out of the scene, then out of
/// objects, and so on until the candidate is free.
class Glide {
 public:
  Glide(const ChunkStep& step, std::size_t e)
      : step_(step),
        e_(e),
        env_(step.state.env(step.first + e)),
        objects_(step.state.resting(step.first + e)),
        exit_(step, e) {
    const Vec3 from = step.state.base(step.first + e);
    const Vec3 to = step.chunk.base(e);
    drive_ = {to.x - from.x, to.z - from.z};
  }

  /// Slides the candidate, which met `met`. Returns whether it is free now.
  bool run(Hindrance met) {
    for (std::uint32_t attempt = 0; attempt < step_.model.options.slide.attempts; ++attempt) {
      if (met == Hindrance::kDrop || !leave(met)) return false;
      met = lookAgain();
      if (met == Hindrance::kNone) return true;
    }
    return false;
  }

 private:
  bool leave(Hindrance met) {
    // A candidate on a floor that is too high has not asked the maps yet.
    if (met == Hindrance::kRise) since_asked_.reset();
    return exit_.addBlocked(met) ? leaveScene(met) : leaveObjects();
  }

  bool leaveScene(Hindrance met) {
    FoundWay way = exit_.shortest(drive_);
    if (way.squared == kNoWay && exit_.turnToColumns(met)) way = exit_.shortest(drive_);
    // If the arm or a turn led into something, the drive is not to blame, and the way out may lead
    // along it.
    if (way.squared == kNoWay && exit_.isOpen() && isBlockedWithoutDrive())
      way = exit_.shortest({});
    if (way.squared == kNoWay) return false;
    const Push moved = exit_.moved();
    const bool is_level = move({way.x - moved.x, way.z - moved.z});
    exit_.follow({way.x, way.z}, is_level);
    return true;
  }

  bool leaveObjects() {
    PushSum sum;
    CollisionScratch& scratch = step_.chunk.collision();
    if (objects_.mayTouch(step_.chunk.extents(e_))) {
      withoutLeft(step_, e_, [&] {
        return pushOutOfObjects(objects_, step_.chunk.spheres(e_), {}, scratch, sum);
      });
    }
    if (env_.held >= 0 && !heldIsSurelyFree(step_, e_)) {
      pushOutOfObjects(objects_, heldSpheres(step_, e_), step_.state.ignored(step_.first + e_),
                       scratch, sum);
    }
    const Push push = sum.total(step_.model.options.slide.step);
    if (push.x == 0 && push.z == 0) return false;
    move(push);
    exit_.begin();
    return true;
  }

  /// Moves the candidate over the floor. Returns whether its height stays the same.
  bool move(const Push& by) {
    const bool is_level = moveBase(step_, e_, by);
    if (!is_level) since_asked_.reset();
    if (since_asked_) since_asked_ = Push{since_asked_->x + by.x, since_asked_->z + by.z};
    return is_level;
  }

  /// The first hindrance of the candidate at its new place.
  Hindrance lookAgain() {
    const Hindrance floor = hindranceByFloor(step_, e_);
    if (floor != Hindrance::kNone) return floor;
    // While the hand holds something, a further search may need the answers about these groups.
    const bool is_sure =
        env_.held < 0 && since_asked_ && isSureAfter(step_, e_, *since_asked_, exit_.suited());
    if (!is_sure) {
      since_asked_.reset();
      if (findBlocked(step_, e_, exit_.suited())) return Hindrance::kScene;
    }
    lookAtHeld(step_, e_);
    return hindranceByObjects(step_, e_);
  }

  /// Whether the scene would block the robot, or the held object, even without the drive.
  [[nodiscard]] bool isBlockedWithoutDrive() {
    if (drive_.x == 0 && drive_.z == 0) return false;
    const Push moved = exit_.moved();
    const Push back{-drive_.x - moved.x, -drive_.z - moved.z};
    step_.chunk.shift(e_, {back.x, 0, back.z});
    since_asked_.reset();
    const bool is_blocked = findBlocked(step_, e_) || exit_.heldIsBlocked();
    step_.chunk.shift(e_, {-back.x, 0, -back.z});
    return is_blocked;
  }

  const ChunkStep& step_;
  std::size_t e_;
  const Env& env_;
  RestingObjects& objects_;
  SceneExit exit_;
  /// How the robot drove in this step.
  Push drive_;
  /// How far the candidate has moved since the maps were asked about it; none if their answers are
  /// not valid for it, because they are about another height or another pose.
  std::optional<Push> since_asked_ = Push{};
};

/// The jitter of the published rule for a sphere in contact: from the sphere towards the base.
Push pushFrom(const ChunkStep& step, std::size_t e, const SphereBatch& spheres,
              std::uint32_t sphere) {
  const Vec3 base = step.chunk.base(e);
  const float x = base.x - spheres.x[sphere];
  const float z = base.z - spheres.z[sphere];
  const float length = std::sqrt(x * x + z * z);
  constexpr float kNoDirection = 1e-3F;
  if (!(length > kNoDirection)) return {};
  const float scale = step.model.options.slide.step / length;
  return {x * scale, z * scale};
}

/// The published rule: the first sphere in contact decides. Checks the robot against the scene, the
/// held object against the scene, then both against the objects. Against the scene, attempts begin
/// alternately with the robot's last sphere and with its first.
class TowardsBase {
 public:
  TowardsBase(const ChunkStep& step, std::size_t e, std::uint32_t attempt)
      : step_(step), e_(e), from_last_(attempt % 2 == 0), obstacles_(obstaclesOf(step, e)) {}

  [[nodiscard]] Push push() const {
    const SphereBatch body = step_.chunk.spheres(e_);
    const std::span<std::uint64_t> body_bits = step_.chunk.bodyBits();
    const bool holds = step_.state.env(step_.first + e_).held >= 0;
    const SphereBatch held = holds ? heldSpheres(step_, e_) : SphereBatch{};
    if (penetratingScene(obstacles_.scene, body, step_.chunk.collision(), body_bits)) {
      return pushFrom(step_, e_, body, firstOfBody(from_last_));
    }
    if (holds) {
      penetratingScene(obstacles_.scene, held, step_.chunk.collision(), step_.chunk.heldBits());
      if (const auto sphere = firstHeld()) return pushFrom(step_, e_, held, *sphere);
    }
    const bool touches = withoutLeft(
        step_, e_, [&] { return penetratingObjects(obstacles_.objects, body, body_bits); });
    if (touches) return pushFrom(step_, e_, body, firstOfBody(false));
    if (!holds) return {};
    penetratingObjects(obstacles_.objects, held, step_.chunk.heldBits());
    const auto sphere = firstHeld();
    return sphere ? pushFrom(step_, e_, held, *sphere) : Push{};
  }

 private:
  /// The first sphere whose bit is set, of which there must be one; the last one if `from_last`.
  [[nodiscard]] std::uint32_t firstOfBody(bool from_last) const {
    const std::span<const std::uint32_t> order = step_.model.motion.spheres_by_link;
    const std::span<const std::uint64_t> bits = step_.chunk.bodyBits();
    const auto is_set = [&](std::uint32_t n) { return hasBit(bits, n); };
    return from_last ? *std::find_if(order.rbegin(), order.rend(), is_set)
                     : *std::find_if(order.begin(), order.end(), is_set);
  }

  [[nodiscard]] std::optional<std::uint32_t> firstHeld() const {
    const IgnoredSpheres ignored = step_.state.ignored(step_.first + e_);
    const std::span<const std::uint64_t> bits = step_.chunk.heldBits();
    for (std::size_t w = 0; w < bits.size(); ++w) {
      const std::uint64_t word = bits[w] & ~ignored[w];
      if (word != 0)
        return static_cast<std::uint32_t>(kBitsPerWord * w) +
               static_cast<std::uint32_t>(std::countr_zero(word));
    }
    return std::nullopt;
  }

  const ChunkStep& step_;
  std::size_t e_;
  bool from_last_;
  Obstacles obstacles_;
};

bool pushTowardsBase(const ChunkStep& step, std::size_t e) {
  for (std::uint32_t attempt = 0; attempt < step.model.options.slide.attempts; ++attempt) {
    if (step.chunk.floor(e) == Floor::kDrops) return false;
    const Push push = TowardsBase(step, e, attempt).push();
    if (push.x == 0 && push.z == 0) return false;
    moveBase(step, e, push);
    if (isFree(step, e)) return true;
  }
  return false;
}

}  // namespace

bool slideClear(const ChunkStep& step, std::size_t e, Hindrance met) noexcept {
  if (met == Hindrance::kObject) step.state.env(step.first + e).knocked = true;
  switch (step.model.options.slide.direction) {
    case SlideDirection::kGlide:
      return Glide(step, e).run(met);
    case SlideDirection::kTowardsBase:
      return pushTowardsBase(step, e);
  }
  return false;
}

}  // namespace galactic::simulation
