#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "simulation/collision/collision.h"
#include "simulation/phases/chunk.h"

namespace galactic::simulation {

/// The first hindrance of a candidate, in the order in which they are checked.
enum class Hindrance : std::uint8_t {
  kNone = 0,
  /// The floor under its base is too deep, or unknown.
  kDrop = 1,
  /// The floor is too high, or offers no height for the base.
  kRise = 2,
  /// The scene blocks spheres of the robot; Chunk::seen() has which.
  kScene = 3,
  /// A resting object touches the robot.
  kObject = 4,
  /// The held object penetrates something.
  kHeld = 5,
};

/// The first hindrance of the candidate of the chunk's env `e`.
[[nodiscard]] Hindrance hindranceOf(const ChunkStep& step, std::size_t e) noexcept;

/// Whether the candidate stands on a floor and penetrates nothing.
[[nodiscard]] inline bool isFree(const ChunkStep& step, std::size_t e) noexcept {
  return hindranceOf(step, e) == Hindrance::kNone;
}

/// How the floor under its base hinders the candidate, if at all.
[[nodiscard]] Hindrance hindranceByFloor(const ChunkStep& step, std::size_t e) noexcept;

/// Asks the maps about the object that the candidate holds, if any.
void lookAtHeld(const ChunkStep& step, std::size_t e) noexcept;

/// The first hindrance of a candidate whose robot neither the floor nor the scene hinders. Call
/// lookAtHeld() first.
[[nodiscard]] Hindrance hindranceByObjects(const ChunkStep& step, std::size_t e) noexcept;

/// Asks maps and slices about all candidates of a chunk at once, so that no query waits for the
/// answer to another.
void lookAtAll(const ChunkStep& step) noexcept;

/// Like hindranceOf(), from what lookAtAll() has found.
[[nodiscard]] Hindrance hindranceAsSeen(const ChunkStep& step, std::size_t e) noexcept;

/// Everything that the env's robot can hit.
[[nodiscard]] Obstacles obstaclesOf(const ChunkStep& step, std::size_t e) noexcept;

/// The spheres of the held object at the candidate's grip.
[[nodiscard]] SphereBatch heldSpheres(const ChunkStep& step, std::size_t e) noexcept;

/// Finds the robot's spheres that the scene blocks and stores them in the chunk. Returns whether
/// there are any.
bool findBlocked(const ChunkStep& step, std::size_t e) noexcept;

/// The same, but skips groups that are known to be free. `free`: eight by eight, as bits.
bool findBlocked(const ChunkStep& step, std::size_t e, std::span<const unsigned> free) noexcept;

/// Whether the maps' last answers prove that all groups but those in `free`, which are free anyway,
/// are still free after a move. `moved`: the move since the maps were asked.
[[nodiscard]] bool isSureAfter(const ChunkStep& step, std::size_t e, const Push& moved,
                               std::span<const unsigned> free) noexcept;

/// Finds the places of the spheres of some groups of an eight and stores them in the chunk. Returns
/// the slices' answers about them.
InSlices findPlaces(const ChunkStep& step, std::size_t e, std::size_t eight,
                    unsigned groups) noexcept;

/// Whether all spheres of the held object are free according to the last query about it.
[[nodiscard]] bool heldIsSurelyFree(const ChunkStep& step, std::size_t e) noexcept;

/// Calls visit(object) for each resting object that the robot is still leaving: see Env::left.
template <class Visit>
void forEachLeft(const ChunkStep& step, std::size_t e, const Visit& visit) {
  const std::size_t n = step.first + e;
  const Env& env = step.state.env(n);
  if (env.left == 0) return;
  for (std::uint32_t object = 0; object < env.objects; ++object) {
    if (!isEmpty(step.state.leaving(n, object))) visit(object);
  }
}

/// Calls `ask` while the objects that the robot is leaving are removed.
template <class Ask>
auto withoutLeft(const ChunkStep& step, std::size_t e, const Ask& ask) {
  RestingObjects& resting = step.state.resting(step.first + e);
  forEachLeft(step, e, [&](std::uint32_t object) { resting.remove(object); });
  const auto answer = ask();
  // The box of a removed object is still stored.
  forEachLeft(step, e, [&](std::uint32_t object) { resting.insert(object, resting.box(object)); });
  return answer;
}

}  // namespace galactic::simulation
