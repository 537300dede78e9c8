#include "simulation/phases/move.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>

#include "simulation/collision/collision.h"
#include "simulation/phases/object_placement.h"
#include "simulation/state/grip_frame.h"

namespace galactic::simulation {
namespace {

Obstacles obstaclesOf(const ChunkStep& step, std::size_t e) {
  const Env& env = step.state.env(step.first + e);
  return {step.model.world->scenes()[env.scene], step.state.resting(step.first + e)};
}

/// The smallest sphere of the working set, standing on a rise as high as the base may climb.
Vec3 floorProbe(const Scene& scene, const Vec3& base, const GroundOptions& options) {
  return {base.x, base.y + options.most_rise + scene.grids().front().radius(), base.z};
}

/// The spheres of the held object at the candidate's grip.
SphereBatch heldSpheres(const ChunkStep& step, std::size_t e) {
  const Env& env = step.state.env(step.first + e);
  const Pose world_from_object = gripPose(step.chunk.grip(e)) * env.held.grip_from_object;
  return holdSpheres(heldModel(step.model, env), world_from_object, step.chunk.placement().spheres);
}

bool isEmpty(std::span<const std::uint64_t> bits) {
  return std::ranges::all_of(bits, [](std::uint64_t word) { return word == 0; });
}

/// Calls visit(object) for each resting object that the robot leaves.
template <class Visit>
void forEachLeft(const ChunkStep& step, std::size_t e, const Visit& visit) {
  const std::size_t n = step.first + e;
  const Env& env = step.state.env(n);
  if (env.left == 0) return;
  for (std::uint32_t object = 0; object < env.objects; ++object) {
    if (!isEmpty(step.state.leaving(n, object))) visit(object);
  }
}

/// Calls `ask` while the objects that the robot leaves are not there.
template <class Ask>
auto withoutLeft(const ChunkStep& step, std::size_t e, const Ask& ask) {
  RestingObjects& resting = step.state.resting(step.first + e);
  forEachLeft(step, e, [&](std::uint32_t object) { resting.remove(object); });
  const auto answer = ask();
  // A box that rests no more is still known.
  forEachLeft(step, e, [&](std::uint32_t object) { resting.insert(object, resting.box(object)); });
  return answer;
}

/// Whether a bit is set that is not ignored.
bool anyCounts(std::span<const std::uint64_t> bits, IgnoredSpheres ignored) {
  std::uint64_t any = 0;
  for (std::size_t w = 0; w < bits.size(); ++w) any |= bits[w] & ~ignored[w];
  return any != 0;
}

/// Finds the robot's spheres that the scene blocks, in the chunk's bits. Whether there is any.
bool findBlocked(const ChunkStep& step, std::size_t e) {
  const Env& env = step.state.env(step.first + e);
  const Scene& scene = step.model.world->scenes()[env.scene];
  const SphereBatch spheres = step.chunk.spheres(e);
  const std::span<const EightSpheres> groups = step.model.groups;
  const std::span<std::uint64_t> bits = step.chunk.blockedBits();
  std::uint64_t any = 0;
  for (std::size_t eight = 0; eight * kLanes < groups.size(); ++eight) {
    const std::size_t here = std::min(groups.size() - eight * kLanes, kLanes);
    const unsigned free =
        step.model.clearance.surelyFree(env.clearance_map, eight, step.chunk.bounds(e, eight));
    const unsigned asked = ((1U << here) - 1) & ~free;
    const std::uint64_t blocked =
        asked == 0 ? 0 : blockedSpheres(scene, spheres, groups, eight * kLanes, asked);
    bits[eight] = blocked;
    any |= blocked;
  }
  return any != 0;
}

bool bodyTouchesObjects(const ChunkStep& step, std::size_t e) {
  const std::size_t n = step.first + e;
  const RestingObjects& objects = step.state.resting(n);
  if (!objects.mayTouch(step.chunk.least(e), step.chunk.most(e))) return false;
  const SphereBatch spheres = step.chunk.spheres(e);
  bool touches = withoutLeft(step, e, [&] { return objects.touches(spheres); });
  forEachLeft(step, e, [&](std::uint32_t object) {
    overlapping(objects.box(object), spheres, step.chunk.bodyBits());
    touches = touches || anyCounts(step.chunk.bodyBits(), step.state.leaving(n, object));
  });
  return touches;
}

/// Whether a look at the ball around the held object's spheres says that all are free.
bool heldIsSurelyFree(const ChunkStep& step, std::size_t e) {
  const Env& env = step.state.env(step.first + e);
  // More than the spheres can leave the ball by through rounding, meters.
  constexpr float kSlack = 1e-3F;
  const Vec3 center = gripToWorld(step.chunk.grip(e), env.held.ball_center);
  const float reach = env.held.ball_radius + kSlack;
  const Vec3 least{center.x - reach, center.y - reach, center.z - reach};
  const Vec3 most{center.x + reach, center.y + reach, center.z + reach};
  if (step.state.resting(step.first + e).mayTouch(least, most)) return false;
  alignas(32) std::array<float, kBounds * kLanes> bounds;
  const std::array<float, kBounds> each{least.x, most.x, least.y, most.y, least.z, most.z};
  for (std::size_t b = 0; b < kBounds; ++b) {
    std::fill_n(bounds.data() + b * kLanes, kLanes, each[b]);
  }
  const ClearanceMaps& maps = step.model.clearance;
  const unsigned free =
      maps.surelyFree(env.clearance_map, maps.eights() - 1, {bounds.data(), kLanes});
  return (env.held.radii & ~free) == 0;
}

bool heldPenetrates(const ChunkStep& step, std::size_t e) {
  if (step.state.env(step.first + e).held.object < 0) return false;
  const std::span<std::uint64_t> bits = step.chunk.heldBits();
  if (heldIsSurelyFree(step, e)) {
    std::ranges::fill(bits, 0U);
    return false;
  }
  const Obstacles obstacles = obstaclesOf(step, e);
  const SphereBatch spheres = heldSpheres(step, e);
  if (!penetrates(obstacles, spheres)) {
    std::ranges::fill(bits, 0U);
    return false;
  }
  penetrating(obstacles, spheres, step.chunk.collision(), bits);
  return anyCounts(bits, step.state.ignored(step.first + e));
}

/// Spheres that are free now count from now on; whether some still do not.
bool keepPenetrating(std::span<std::uint64_t> ignored, std::span<const std::uint64_t> bits) {
  std::uint64_t any = 0;
  for (std::size_t w = 0; w < ignored.size(); ++w) {
    ignored[w] &= bits[w];
    any |= ignored[w];
  }
  return any != 0;
}

/// The candidate is the robot's pose from now on.
void accept(const ChunkStep& step, std::size_t e) {
  const std::size_t n = step.first + e;
  const PoseArrays to = step.state.poses(n);
  const PoseArrays from = step.chunk.candidates(e);
  *to.x = *from.x;
  *to.y = *from.y;
  *to.z = *from.z;
  *to.yaw = *from.yaw;
  for (std::size_t v = 0; v < step.model.variableCount(); ++v) {
    to.variables[v * to.stride] = from.variables[v * from.stride];
  }
  step.state.grip(n) = step.chunk.grip(e);
  std::ranges::copy(step.chunk.bodyTransforms(e), step.state.bodyTransforms(n).begin());
  // The bits are those of the accepted candidate.
  Env& env = step.state.env(n);
  if (env.held.object >= 0) keepPenetrating(step.state.ignored(n), step.chunk.heldBits());
  forEachLeft(step, e, [&](std::uint32_t object) {
    overlapping(step.state.resting(n).box(object), step.chunk.spheres(e), step.chunk.bodyBits());
    const bool any = keepPenetrating(step.state.leaving(n, object), step.chunk.bodyBits());
    env.left -= any ? 0U : 1U;
  });
}

/// Adds the ways out of the scene for the robot's spheres that it blocks.
void pushBodyOutOfScene(const ChunkStep& step, std::size_t e, PushSum& sum) {
  const Scene& scene = obstaclesOf(step, e).scene;
  const SphereBatch spheres = step.chunk.spheres(e);
  const std::span<const std::uint64_t> bits = step.chunk.blockedBits();
  for (std::size_t w = 0; w < bits.size(); ++w) {
    for (std::uint64_t word = bits[w]; word != 0; word &= word - 1) {
      const std::size_t n = 64 * w + static_cast<std::size_t>(std::countr_zero(word));
      const ColumnGrid& grid = scene.grids()[step.model.groups[n / kLanes].radius_index];
      sum.add(pushOutOfScene(grid, {spheres.x[n], spheres.y[n], spheres.z[n]},
                             step.model.options.slide.step));
    }
  }
}

/// Where the base has to go so that what penetrates gets free, in one jitter: after isFree() has
/// said that something does.
Push pushOf(const ChunkStep& step, std::size_t e) {
  const SlideOptions& options = step.model.options.slide;
  const Obstacles obstacles = obstaclesOf(step, e);
  const Env& env = step.state.env(step.first + e);
  PushSum sum;
  if (step.chunk.floor(e) != Floor::kCarries) findBlocked(step, e);
  pushBodyOutOfScene(step, e, sum);
  if (obstacles.objects.mayTouch(step.chunk.least(e), step.chunk.most(e))) {
    withoutLeft(step, e, [&] {
      return pushOutOfObjects(obstacles.objects, step.chunk.spheres(e), {}, step.chunk.collision(),
                              sum);
    });
  }
  if (env.held.object >= 0 && !heldIsSurelyFree(step, e)) {
    pushOut(obstacles, heldSpheres(step, e), step.state.ignored(step.first + e), options.step,
            step.chunk.collision(), sum);
  }
  if (step.chunk.floor(e) == Floor::kBlocks) {
    const Vec3 probe = floorProbe(obstacles.scene, step.chunk.base(e), step.model.options.ground);
    sum.add(pushOutOfScene(obstacles.scene.grids().front(), probe, options.step));
  }
  return sum.total(options.step);
}

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

}  // namespace

FloorUnder floorUnder(const Scene& scene, const Vec3& base, const GroundOptions& options) noexcept {
  const ColumnGrid& grid = scene.grids().front();
  const Vec3 probe = floorProbe(scene, base, options);
  const Contact contact = grid.contact(probe);
  if (contact.clearance == Clearance::kBlocked) return {Floor::kBlocks, base.y};
  if (contact.clearance == Clearance::kOutside) return {Floor::kDrops, base.y};
  const float height = probe.y - contact.down - grid.radius();
  if (height < base.y - options.most_drop) return {Floor::kDrops, base.y};
  return {Floor::kCarries, height};
}

bool isFree(const ChunkStep& step, std::size_t e) noexcept {
  if (step.chunk.floor(e) != Floor::kCarries) return false;
  return !findBlocked(step, e) && !bodyTouchesObjects(step, e) && !heldPenetrates(step, e);
}

void proposePoses(const ChunkStep& step) noexcept {
  const std::size_t actions = step.model.actionCount();
  for (std::size_t e = 0; e < kChunk; e += kLanes) {
    step.model.kernels.move(step.model.tables,
                            {.actions = step.chunk.actions().data() + e * actions,
                             .action_count = actions,
                             .from = step.state.poses(step.first + e),
                             .to = step.chunk.candidates(e)});
  }
}

void followFloor(const ChunkStep& step) noexcept {
  for (std::size_t e = 0; e < kChunk; ++e) {
    const Scene& scene = step.model.world->scenes()[step.state.env(step.first + e).scene];
    const FloorUnder under = floorUnder(scene, step.chunk.base(e), step.model.options.ground);
    step.chunk.floor(e) = under.floor;
    *step.chunk.candidates(e).y = under.height;
  }
}

void placeBodies(const ChunkStep& step) noexcept {
  // While the kernels calculate, what the collision tests read comes nearer.
  for (std::size_t e = 0; e < kChunk; ++e) step.state.resting(step.first + e).prefetch();
  for (std::size_t e = 0; e < kChunk; e += kLanes) {
    step.model.kernels.place(step.model.tables, {.pose = step.chunk.candidates(e),
                                                 .body = step.chunk.bodies(e),
                                                 .scratch = step.chunk.frames()});
  }
}

bool pushClear(const ChunkStep& step, std::size_t e) noexcept {
  const SlideOptions& options = step.model.options.slide;
  const Scene& scene = step.model.world->scenes()[step.state.env(step.first + e).scene];
  const float floor_before = *step.state.poses(step.first + e).y;
  for (std::uint32_t attempt = 0; attempt < options.attempts; ++attempt) {
    if (step.chunk.floor(e) == Floor::kDrops) return false;
    const Push push = options.direction == SlideDirection::kPushOut
                          ? pushOf(step, e)
                          : TowardsBase(step, e, attempt).push();
    if (push.x == 0 && push.z == 0) return false;
    const Vec3 base = step.chunk.base(e);
    const FloorUnder under = floorUnder(scene, {base.x + push.x, floor_before, base.z + push.z},
                                        step.model.options.ground);
    step.chunk.floor(e) = under.floor;
    step.chunk.shift(e, {push.x, under.height - base.y, push.z});
    if (isFree(step, e)) return true;
  }
  return false;
}

void moveRobots(const ChunkStep& step) noexcept {
  for (std::size_t e = 0; e < kChunk; ++e) {
    Env& env = step.state.env(step.first + e);
    if (step.state.idle()[step.first + e] != 0) continue;
    env.refused = false;
    if (isFree(step, e)) {
      accept(step, e);
    } else if (pushClear(step, e)) {
      ++env.counters.slid;
      accept(step, e);
    } else {
      ++env.counters.refused;
      env.refused = true;
    }
  }
}

}  // namespace galactic::simulation
