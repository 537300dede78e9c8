#include "simulation/phases/move.h"

#include <algorithm>
#include <array>
#include <bit>

#include "simulation/collision/collision.h"
#include "simulation/phases/contacts.h"
#include "simulation/phases/robot_noise.h"
#include "simulation/phases/slide.h"
#include "simulation/phases/walk.h"

namespace galactic::simulation {
namespace {

/// Accepts the candidate, except for its pose, grip and bodies: updates the spheres that do not
/// count.
void accept(const ChunkStep& step, std::size_t e) {
  const std::size_t n = step.first + e;
  // The chunk's bits are those of the accepted candidate.
  Env& env = step.state.env(n);
  if (env.ignores) env.ignores = keepPenetrating(step.state.ignored(n), step.chunk.heldBits());
  forEachLeft(step, e, [&](std::uint32_t object) {
    overlapping(step.state.resting(n).box(object), step.chunk.spheres(e), step.chunk.bodyBits());
    const bool any = keepPenetrating(step.state.leaving(n, object), step.chunk.bodyBits());
    env.left -= any ? 0U : 1U;
  });
}

/// Like walkToCandidate(), but checks only the end of the way, about which lookAtAll() has asked.
Walk jumpToCandidate(const ChunkStep& step, std::size_t e) {
  const Hindrance met = hindranceAsSeen(step, e);
  if (met == Hindrance::kNone) return Walk::kStraight;
  return slideClear(step, e, met) ? Walk::kHindered : Walk::kNone;
}

/// Copies the poses and grips of accepted candidates: each number for all envs at once, without a
/// branch.
void acceptPoses(const ChunkStep& step, const EnvMask& accepted) {
  const std::span<EnvRow> to = step.state.poseRows(step.first);
  const std::span<const EnvRow> from = step.chunk.poseRows();
  if (std::ranges::all_of(accepted, [](std::uint32_t lane) { return lane != 0; })) {
    std::ranges::copy(from, to.begin());
    return;
  }
  for (std::size_t n = 0; n < to.size(); ++n) {
    const float* candidate = from[n].values;
    float* old = to[n].values;
    std::array<float, kChunk> kept;
    for (std::size_t e = 0; e < kChunk; ++e) {
      const auto mine = std::bit_cast<std::uint32_t>(candidate[e]) & accepted[e];
      kept[e] = std::bit_cast<float>(mine | (std::bit_cast<std::uint32_t>(old[e]) & ~accepted[e]));
    }
    std::ranges::copy(kept, old);
  }
}

/// Puts candidates in one scene on the floors under them.
void followFloorsOf(const Scene& scene, const ChunkStep& step, std::size_t first,
                    std::size_t count) {
  static_assert(kChunk <= kMostBases);
  std::array<Vec3, kChunk> bases;
  for (std::size_t n = 0; n < count; ++n) bases[n] = step.chunk.base(first + n);
  std::array<FloorUnder, kChunk> under;
  floorsUnder(scene, std::span(bases).first(count), step.model.options.ground,
              std::span(under).first(count));
  for (std::size_t n = 0; n < count; ++n) {
    step.chunk.floor(first + n) = under[n].floor;
    *step.chunk.candidates(first + n).y = under[n].height;
  }
}

/// Whether all these envs are in the same scene.
bool areInOneScene(const ChunkStep& step, std::size_t first, std::size_t count) {
  const auto scene_of = [&](std::size_t e) { return step.state.env(step.first + e).scene; };
  std::uint32_t others = 0;
  for (std::size_t n = 1; n < count; ++n) others |= scene_of(first + n) ^ scene_of(first);
  return others == 0;
}

/// Puts candidates on level floors. Returns whether all stand on one; if not, changes nothing.
bool followLevelFloors(const ChunkStep& step, std::size_t first, std::size_t count) {
  std::array<std::uint32_t, kChunk> maps;
  std::uint32_t others = 0;
  for (std::size_t n = 0; n < count; ++n) {
    maps[n] = step.state.env(step.first + first + n).clearance_map;
    others |= maps[n] ^ maps[0];
  }
  const LevelFloors& floors = step.model.level_floors;
  const PoseArrays base = step.chunk.candidates(first);
  std::array<float, kChunk> heights{};
  bool are_known = true;
  if (others == 0) {
    are_known = floors.heightsUnder(maps[0], {base.x, base.y, base.z, count}, heights.data());
  } else {
    for (std::size_t n = 0; n < count && are_known; ++n) {
      const auto height = floors.heightUnder(maps[n], step.chunk.base(first + n));
      are_known = height.has_value();
      heights[n] = height.value_or(0);
    }
  }
  if (!are_known) return false;
  std::copy_n(heights.begin(), count, base.y);
  for (std::size_t n = 0; n < count; ++n) step.chunk.floor(first + n) = Floor::kCarries;
  return true;
}

}  // namespace

void copyPose(const PoseArrays& from, const PoseArrays& to, std::size_t variables) noexcept {
  *to.x = *from.x;
  *to.y = *from.y;
  *to.z = *from.z;
  *to.yaw = *from.yaw;
  for (std::size_t v = 0; v < variables; ++v) {
    to.variables[v * to.stride] = from.variables[v * from.stride];
  }
}

Vec3 floorProbe(const ChunkStep& step, std::size_t e) noexcept {
  const std::size_t n = step.first + e;
  return floorProbe(step.model.scenes[step.state.env(n).scene], step.chunk.base(e),
                    step.state.base(n), step.model.options.ground);
}

void keepBodies(const ChunkStep& step, const EnvMask& wanted) noexcept {
  static_assert(sizeof(RigidTransform) == kFrameNumbers * sizeof(float));
  const std::span<RigidTransform> to = step.state.bodyTransforms(step.first);
  if (to.empty()) return;
  step.model.kernels.put_frames({.frames = step.chunk.frames().front().values,
                                 .rows = step.chunk.frames().size(),
                                 .wanted = wanted.data(),
                                 .to = &to.front().x_axis.x,
                                 .envs = kChunk});
}

FloorUnder floorUnder(const ChunkStep& step, std::size_t e, const Vec3& base) noexcept {
  const Env& env = step.state.env(step.first + e);
  const auto height = step.model.level_floors.heightUnder(env.clearance_map, base);
  if (height) return {Floor::kCarries, *height};
  return floorUnder(step.model.scenes[env.scene], base, step.model.options.ground);
}

void proposePoses(const ChunkStep& step) noexcept {
  step.model.kernels.move(step.model.tables, {.actions = motionsOf(step).front().values,
                                              .joints = step.model.motion.controlled.size(),
                                              .from = step.state.poses(step.first),
                                              .to = step.chunk.candidates(0),
                                              .envs = kChunk});
}

void followFloor(const ChunkStep& step) noexcept {
  const auto scene_of = [&](std::size_t e) -> const Scene& {
    return step.model.scenes[step.state.env(step.first + e).scene];
  };
  if (followLevelFloors(step, 0, kChunk)) return;
  if (areInOneScene(step, 0, kChunk)) return followFloorsOf(scene_of(0), step, 0, kChunk);
  for (std::size_t first = 0; first < kChunk; first += kLanes) {
    if (followLevelFloors(step, first, kLanes)) continue;
    if (areInOneScene(step, first, kLanes)) {
      followFloorsOf(scene_of(first), step, first, kLanes);
      continue;
    }
    for (std::size_t e = first; e < first + kLanes; ++e) {
      const FloorUnder under = floorUnder(step, e, step.chunk.base(e));
      step.chunk.floor(e) = under.floor;
      *step.chunk.candidates(e).y = under.height;
    }
  }
}

void placeBodies(const ChunkStep& step) noexcept {
  step.model.kernels.place(
      step.model.tables,
      {.pose = step.chunk.candidates(0), .body = step.chunk.bodies(0), .envs = kChunk});
}

void moveRobots(const ChunkStep& step) noexcept {
  EnvMask accepted{};
  if (step.between == nullptr) lookAtAll(step);
  step.state.prefetchChunk(step.first + kChunk);
  for (std::size_t e = 0; e < kChunk; ++e) {
    // A thread steps one chunk after another. Prefetched during the longest phase, the data of the
    // next chunk arrives in time, and no load has to queue behind many others.
    step.state.prefetch(step.first + kChunk + e);
    Env& env = step.state.env(step.first + e);
    if (step.state.idle()[step.first + e] != 0) continue;
    env.refused = env.knocked = false;
    const Walk walk = step.between == nullptr ? jumpToCandidate(step, e) : walkToCandidate(step, e);
    if (walk == Walk::kNone) {
      ++step.state.moves(step.first + e).refused;
      env.refused = true;
      continue;
    }
    if (walk == Walk::kHindered) ++step.state.moves(step.first + e).slid;
    accept(step, e);
    accepted[e] = ~std::uint32_t{0};
  }
  acceptPoses(step, accepted);
  keepBodies(step, accepted);
}

}  // namespace galactic::simulation
