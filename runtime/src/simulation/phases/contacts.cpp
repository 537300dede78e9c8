#include "simulation/phases/contacts.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "simulation/phases/object_placement.h"
#include "simulation/state/grip_frame.h"

namespace galactic::simulation {
namespace {

bool bodyTouchesObjects(const ChunkStep& step, std::size_t e) {
  const std::size_t n = step.first + e;
  const RestingObjects& objects = step.state.resting(n);
  if (!objects.mayTouch(step.chunk.extents(e))) return false;
  const BoundedSpheres robot = step.chunk.boundedSpheres(e);
  bool touches = withoutLeft(step, e, [&] { return objects.touches(robot); });
  forEachLeft(step, e, [&](std::uint32_t object) {
    overlapping(objects.box(object), step.chunk.spheres(e), step.chunk.bodyBits());
    touches = touches || anyCounts(step.chunk.bodyBits(), step.state.leaving(n, object));
  });
  return touches;
}

/// The groups that an eight really has, as bits.
unsigned groupsOf(const Model& model, std::size_t eight) {
  return (1U << std::min(model.groups.size() - eight * kLanes, kLanes)) - 1;
}

std::uint32_t mapOf(const ChunkStep& step, std::size_t e) {
  return step.state.env(step.first + e).clearance_map;
}

/// Bounds of the ball around the object that the candidate holds.
CenterBounds boundsOfHeld(const ChunkStep& step, std::size_t e) {
  const Held& held = step.state.held(step.first + e);
  // Rounding moves no sphere further out of the ball than this, meters.
  constexpr float kSlack = 1e-3F;
  const Vec3 center = gripToWorld(step.chunk.grip(e), held.ball_center);
  const float reach = held.ball_radius + kSlack;
  const Vec3 least{center.x - reach, center.y - reach, center.z - reach};
  const Vec3 most{center.x + reach, center.y + reach, center.z + reach};
  return {{least.x, most.x, least.y, most.y, least.z, most.z, least.z, most.z}};
}

/// Asks the maps about what several candidates hold, so that no query waits for the answer to
/// another.
void lookAtHeld(const ChunkStep& step, std::span<const std::size_t> holding) {
  std::array<std::uint32_t, kChunk> maps;
  std::array<CenterBounds, kChunk> bounds;
  for (std::size_t n = 0; n < holding.size(); ++n) {
    maps[n] = mapOf(step, holding[n]);
    bounds[n] = boundsOfHeld(step, holding[n]);
  }
  std::array<unsigned, kChunk> free;
  const ClearanceMaps& clearance = step.model.clearance;
  clearance.surelyFree(std::span(maps).first(holding.size()), clearance.eights() - 1, bounds, free);
  for (std::size_t n = 0; n < holding.size(); ++n) {
    const std::uint32_t radii = step.state.held(step.first + holding[n]).radii;
    step.chunk.seenHeld(holding[n]) = {bounds[n], (radii & ~free[n]) == 0};
  }
}

void lookAtAllHeld(const ChunkStep& step) {
  std::array<std::size_t, kChunk> holding;
  std::size_t count = 0;
  for (std::size_t e = 0; e < kChunk; ++e) {
    holding[count] = e;
    count += step.state.env(step.first + e).held >= 0 ? 1U : 0U;
  }
  if (count > 0) lookAtHeld(step, std::span(holding).first(count));
}

/// For searches in which no group is known to be free.
unsigned noGroups(std::size_t) { return 0; }

/// Like findBlocked(), after the maps have been asked. `look`: returns the slices' answers about
/// some groups of an eight. `free`: returns the groups of an eight that are known to be free.
template <class Look, class Free>
bool findBlockedBy(const Look& look, const Free& free, const ChunkStep& step, std::size_t e) {
  const Env& env = step.state.env(step.first + e);
  const Scene& scene = step.model.scenes[env.scene];
  const std::span<const EightSpheres> groups = step.model.groups;
  std::uint64_t any = 0;
  for (std::size_t eight = 0; eight * kLanes < groups.size(); ++eight) {
    const SureGroups& sure = step.chunk.sure(eight)[e];
    SeenGroups& seen = step.chunk.seen(eight);
    seen.unsure = groupsOf(step.model, eight) & ~free(eight) & ~sure.free;
    const InSlices found = look(eight, seen.unsure);
    seen.blocked = found.blocked;
    if (found.unknown != 0) {
      seen.blocked |=
          blockedSpheres(scene, step.chunk.spheres(e), groups, eight * kLanes, found.unknown);
    }
    any |= seen.blocked;
  }
  return any != 0;
}

template <class Free>
bool findBlockedBut(const Free& free, const ChunkStep& step, std::size_t e) {
  for (std::size_t eight = 0; eight * kLanes < step.model.groups.size(); ++eight) {
    step.model.clearance.surelyFree(mapOf(step, e), eight, step.chunk.bounds(e, eight),
                                    step.chunk.sure(eight)[e]);
  }
  const auto look = [&](std::size_t eight, unsigned groups) {
    return findPlaces(step, e, eight, groups);
  };
  return findBlockedBy(look, free, step, e);
}

bool heldPenetrates(const ChunkStep& step, std::size_t e) {
  if (step.state.env(step.first + e).held < 0) return false;
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

}  // namespace

Obstacles obstaclesOf(const ChunkStep& step, std::size_t e) noexcept {
  const Env& env = step.state.env(step.first + e);
  return {step.model.scenes[env.scene], step.state.resting(step.first + e)};
}

SphereBatch heldSpheres(const ChunkStep& step, std::size_t e) noexcept {
  const Env& env = step.state.env(step.first + e);
  const Pose world_from_object =
      gripPose(step.chunk.grip(e)) * step.state.held(step.first + e).grip_from_object;
  return holdSpheres(heldModel(step.model, env), world_from_object, step.chunk.placement().spheres);
}

InSlices findPlaces(const ChunkStep& step, std::size_t e, std::size_t eight,
                    unsigned groups) noexcept {
  if (groups == 0) return {};
  const SphereBatch spheres = step.chunk.spheres(e);
  const std::size_t first = eight * kLanes * kLanes;
  return step.model.slices.findPlaces(mapOf(step, e), eight * kLanes,
                                      {.x = spheres.x + first,
                                       .y = spheres.y + first,
                                       .z = spheres.z + first,
                                       .asked = groups,
                                       .places = step.chunk.places(e, eight)});
}

void lookAtHeld(const ChunkStep& step, std::size_t e) noexcept {
  if (step.state.env(step.first + e).held >= 0) lookAtHeld(step, std::span(&e, 1));
}

void lookAtAll(const ChunkStep& step) noexcept {
  static_assert(kChunk <= ClearanceMaps::kMostAsked && kChunk % kEnvsAsked == 0);
  std::array<std::uint32_t, kChunk> maps;
  for (std::size_t e = 0; e < kChunk; ++e) maps[e] = mapOf(step, e);
  for (std::size_t eight = 0; eight * kLanes < step.model.groups.size(); ++eight) {
    const std::span<SureGroups> sure = step.chunk.sure(eight);
    step.model.clearance.surelyFree(maps, eight, step.chunk.bounds(0, eight),
                                    step.chunk.boundsStride(), sure);
    const std::span<InSlices> found = step.chunk.inSlices(eight);
    std::ranges::fill(found, InSlices{});
    const unsigned groups = groupsOf(step.model, eight);
    for (std::size_t first = 0; first < kChunk; first += kEnvsAsked) {
      std::uint64_t asked = 0;
      for (std::size_t n = 0; n < kEnvsAsked; ++n) {
        asked |= std::uint64_t{groups & ~sure[first + n].free} << (kLanes * n);
      }
      const SphereBatch spheres = step.chunk.spheres(first);
      const std::size_t sphere = eight * kLanes * kLanes;
      step.model.slices.findPlaces(std::span(maps).subspan(first, kEnvsAsked), eight * kLanes,
                                   {.x = spheres.x + sphere,
                                    .y = spheres.y + sphere,
                                    .z = spheres.z + sphere,
                                    .stride = step.chunk.spheresStride(),
                                    .asked = asked,
                                    .places = step.chunk.places(first, eight),
                                    .places_stride = step.chunk.placesStride(),
                                    .found = &found[first]});
    }
  }
  lookAtAllHeld(step);
}

bool findBlocked(const ChunkStep& step, std::size_t e) noexcept {
  return findBlockedBut(noGroups, step, e);
}

bool findBlocked(const ChunkStep& step, std::size_t e, std::span<const unsigned> free) noexcept {
  return findBlockedBut([&](std::size_t eight) { return free[eight]; }, step, e);
}

bool isSureAfter(const ChunkStep& step, std::size_t e, const Push& moved,
                 std::span<const unsigned> free) noexcept {
  unsigned unsure = 0;
  for (std::size_t eight = 0; eight * kLanes < step.model.groups.size(); ++eight) {
    const SureGroups& sure = step.chunk.sure(eight)[e];
    const unsigned known =
        free[eight] | step.model.clearance.freeAfter(mapOf(step, e), eight, sure, moved.x, moved.z);
    unsure |= groupsOf(step.model, eight) & ~known;
  }
  return unsure == 0;
}

bool heldIsSurelyFree(const ChunkStep& step, std::size_t e) noexcept {
  const SeenHeld& seen = step.chunk.seenHeld(e);
  return seen.clears_scene && !step.state.resting(step.first + e).mayTouch(seen.bounds);
}

Hindrance hindranceByFloor(const ChunkStep& step, std::size_t e) noexcept {
  switch (step.chunk.floor(e)) {
    case Floor::kCarries:
      return Hindrance::kNone;
    case Floor::kBlocks:
      return Hindrance::kRise;
    case Floor::kDrops:
      return Hindrance::kDrop;
  }
  return Hindrance::kDrop;
}

Hindrance hindranceByObjects(const ChunkStep& step, std::size_t e) noexcept {
  if (bodyTouchesObjects(step, e)) return Hindrance::kObject;
  return heldPenetrates(step, e) ? Hindrance::kHeld : Hindrance::kNone;
}

Hindrance hindranceAsSeen(const ChunkStep& step, std::size_t e) noexcept {
  const Hindrance floor = hindranceByFloor(step, e);
  if (floor != Hindrance::kNone) return floor;
  const auto seen = [&](std::size_t eight, unsigned) { return step.chunk.inSlices(eight)[e]; };
  return findBlockedBy(seen, noGroups, step, e) ? Hindrance::kScene : hindranceByObjects(step, e);
}

Hindrance hindranceOf(const ChunkStep& step, std::size_t e) noexcept {
  const Hindrance floor = hindranceByFloor(step, e);
  if (floor != Hindrance::kNone) return floor;
  if (findBlocked(step, e)) return Hindrance::kScene;
  lookAtHeld(step, e);
  return hindranceByObjects(step, e);
}

}  // namespace galactic::simulation
