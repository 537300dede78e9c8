#include "simulation/phases/slide.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>

#include "simulation/phases/contacts.h"
#include "simulation/phases/move.h"

namespace galactic::simulation {
namespace {

/// Moves the candidate over the floor. Whether it is as high as before.
bool moveBase(const ChunkStep& step, std::size_t e, const Push& by) {
  const Scene& scene = step.model.world->scenes()[step.state.env(step.first + e).scene];
  const float floor_before = *step.state.poses(step.first + e).y;
  const Vec3 base = step.chunk.base(e);
  const FloorUnder under =
      floorUnder(scene, {base.x + by.x, floor_before, base.z + by.z}, step.model.options.ground);
  step.chunk.floor(e) = under.floor;
  step.chunk.shift(e, {by.x, under.height - base.y, by.z});
  return under.height == base.y;
}

float partOf(float cell) { return cell - std::floor(cell); }

/// Slides one candidate along what blocks it: the shortest move out of the scene, then out of
/// objects, and so on until it is free.
class Glide {
 public:
  Glide(const ChunkStep& step, std::size_t e)
      : step_(step),
        e_(e),
        env_(step.state.env(step.first + e)),
        obstacles_(obstaclesOf(step, e)),
        way_(step.chunk.wayOut()) {
    const Vec3 from = step.state.base(step.first + e);
    const Vec3 to = step.chunk.base(e);
    drive_ = {to.x - from.x, to.z - from.z};
    begin();
  }

  /// isFree() has said that the candidate is not. Whether it is now.
  bool run() {
    for (std::uint32_t attempt = 0; attempt < step_.model.options.slide.attempts; ++attempt) {
      if (step_.chunk.floor(e_) == Floor::kDrops) return false;
      if (!(addBlocked() ? leaveScene() : leaveObjects())) return false;
      if (isStillFree(step_, e_)) return true;
    }
    return false;
  }

 private:
  /// The way out is sought from where the candidate is now.
  void begin() {
    way_.clear(obstacles_.scene.grids().front().spacing());
    moved_ = {};
    step_.chunk.forgetSuited();
  }

  /// Adds the spheres that decide where the way out of the scene leads. Whether the scene blocks
  /// any.
  bool addBlocked() {
    const bool floor_blocks = step_.chunk.floor(e_) == Floor::kBlocks;
    if (floor_blocks) {
      findBlocked(step_, e_);
      const Vec3 probe =
          floorProbe(obstacles_.scene, step_.chunk.base(e_), step_.model.options.ground);
      addSphere(0, probe);
    }
    const bool body = !isEmpty(step_.chunk.blockedBits());
    if (body || floor_blocks) addBody();
    // isFree() asks about what the robot holds when the robot itself is free.
    return body || floor_blocks || addHeld();
  }

  /// Adds the robot's spheres in all groups that are not free as a whole: those that are blocked,
  /// and those of which it is known where they are free.
  void addBody() {
    const SphereBatch spheres = step_.chunk.spheres(e_);
    for (std::size_t n = 0; n < step_.model.groups.size(); ++n) {
      GroupBits& known = step_.chunk.groupBits(n / kLanes);
      const unsigned bit = 1U << (n % kLanes);
      if ((known.unsure & bit) == 0) continue;
      const EightSpheres& group = step_.model.groups[n];
      const EightPlaces& places = step_.chunk.places(n);
      const std::uint64_t word = step_.chunk.blockedBits()[n / kLanes];
      const auto blocked = static_cast<unsigned>(word >> (n % kLanes * kLanes) & 0xffU);
      const unsigned added = group.spheres & (places.free | blocked);
      if (added == group.spheres) known.suited |= bit;
      const bool at_places = moved_.x == 0 && moved_.z == 0;
      for (unsigned left = added; left != 0; left &= left - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(left));
        const std::size_t sphere = n * kLanes + lane;
        if (at_places && (places.inside >> lane & 1U) != 0) {
          way_.add(step_.model.slices.around(env_.clearance_map, group.radius_index, places, lane),
                   places.part_x[lane], places.part_z[lane]);
        } else {
          addSphere(group.radius_index, {spheres.x[sphere], spheres.y[sphere], spheres.z[sphere]});
        }
      }
    }
  }

  /// The same for what the robot holds. Whether the scene blocks any of it.
  bool addHeld() {
    const bool penetrates = env_.held.object >= 0 && !isEmpty(step_.chunk.heldBits());
    if (!penetrates) return false;
    const SphereBatch held = heldSpheres(step_, e_);
    const IgnoredSpheres ignored = step_.state.ignored(step_.first + e_);
    bool any = false;
    for (const RadiusRange& range : held.ranges) {
      const ColumnGrid& grid = obstacles_.scene.grids()[range.radius_index];
      for (std::uint32_t n = range.first; n < range.first + range.count; ++n) {
        if ((ignored[n / 64] >> (n % 64) & 1U) != 0) continue;
        const Vec3 center{held.x[n], held.y[n], held.z[n]};
        any = any || grid.clearance(center) != Clearance::kFree;
        addSphere(range.radius_index, center);
      }
    }
    return any;
  }

  /// `center`: where the sphere is now.
  void addSphere(std::uint32_t radius, const Vec3& center) {
    const ColumnGrid& grid = obstacles_.scene.grids()[radius];
    const Vec3 before{center.x - moved_.x, center.y, center.z - moved_.z};
    const auto around = step_.model.slices.around(env_.clearance_map, radius, before);
    const ColumnGridLayout& layout = grid.layout();
    const float part_x = partOf((before.x - layout.min_x) * layout.inverse_spacing);
    const float part_z = partOf((before.z - layout.min_z) * layout.inverse_spacing);
    if (around) {
      way_.add(*around, part_x, part_z);
    } else {
      way_.add(surroundingsOf(grid, before), part_x, part_z);
    }
  }

  bool leaveScene() {
    const std::optional<Push> push = way_.shortest(drive_, step_.model.options.slide.step);
    if (!push) return false;
    const bool is_level = moveBase(step_, e_, {push->x - moved_.x, push->z - moved_.z});
    if (!is_level) step_.chunk.forgetSuited();
    moved_ = *push;
    return true;
  }

  bool leaveObjects() {
    PushSum sum;
    CollisionScratch& scratch = step_.chunk.collision();
    if (obstacles_.objects.mayTouch(step_.chunk.least(e_), step_.chunk.most(e_))) {
      withoutLeft(step_, e_, [&] {
        return pushOutOfObjects(obstacles_.objects, step_.chunk.spheres(e_), {}, scratch, sum);
      });
    }
    if (env_.held.object >= 0 && !heldIsSurelyFree(step_, e_)) {
      pushOutOfObjects(obstacles_.objects, heldSpheres(step_, e_),
                       step_.state.ignored(step_.first + e_), scratch, sum);
    }
    const Push push = sum.total(step_.model.options.slide.step);
    if (push.x == 0 && push.z == 0) return false;
    moveBase(step_, e_, push);
    begin();
    return true;
  }

  const ChunkStep& step_;
  std::size_t e_;
  const Env& env_;
  Obstacles obstacles_;
  WayOut& way_;
  Push drive_;
  /// From where the way out was begun.
  Push moved_;
};

/// The jitter of the published rule away from a sphere: towards the base.
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

/// The published rule asks about one thing after the other, and the first sphere in contact
/// decides: the robot in the scene, what it holds in the scene, then both among the objects. In the
/// scene, attempts take turns to begin with the robot's last sphere and with its first.
class TowardsBase {
 public:
  TowardsBase(const ChunkStep& step, std::size_t e, std::uint32_t attempt)
      : step_(step), e_(e), from_last_(attempt % 2 == 0), obstacles_(obstaclesOf(step, e)) {}

  [[nodiscard]] Push push() const {
    const SphereBatch body = step_.chunk.spheres(e_);
    const std::span<std::uint64_t> body_bits = step_.chunk.bodyBits();
    const bool holds = step_.state.env(step_.first + e_).held.object >= 0;
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
  /// Of those whose bit is set, one of which there is.
  [[nodiscard]] std::uint32_t firstOfBody(bool from_last) const {
    const std::span<const std::uint32_t> order = step_.model.motion.spheres_by_link;
    const std::span<const std::uint64_t> bits = step_.chunk.bodyBits();
    const auto is_set = [&](std::uint32_t n) { return (bits[n / 64] >> (n % 64) & 1U) != 0; };
    return from_last ? *std::find_if(order.rbegin(), order.rend(), is_set)
                     : *std::find_if(order.begin(), order.end(), is_set);
  }

  [[nodiscard]] std::optional<std::uint32_t> firstHeld() const {
    const IgnoredSpheres ignored = step_.state.ignored(step_.first + e_);
    const std::span<const std::uint64_t> bits = step_.chunk.heldBits();
    for (std::size_t w = 0; w < bits.size(); ++w) {
      const std::uint64_t word = bits[w] & ~ignored[w];
      if (word != 0)
        return static_cast<std::uint32_t>(64 * w) +
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

bool slideClear(const ChunkStep& step, std::size_t e) noexcept {
  switch (step.model.options.slide.direction) {
    case SlideDirection::kGlide:
      return Glide(step, e).run();
    case SlideDirection::kTowardsBase:
      return pushTowardsBase(step, e);
  }
  return false;
}

}  // namespace galactic::simulation
