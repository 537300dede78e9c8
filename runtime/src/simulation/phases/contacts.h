#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "simulation/collision/collision.h"
#include "simulation/phases/chunk.h"

namespace galactic::simulation {

/// What hinders a candidate: the first of these, in the order in which they are looked for.
enum class Hindrance : std::uint8_t {
  kNone = 0,
  /// The floor under its base is too deep, or unknown.
  kDrop = 1,
  /// The floor is too high, or there is no height for the base.
  kRise = 2,
  /// The scene blocks spheres of the robot, which are those of Chunk::seen().
  kScene = 3,
  /// A resting object touches the robot.
  kObject = 4,
  /// What the robot holds penetrates something.
  kHeld = 5,
};

/// What hinders the candidate of the chunk's env `e`.
[[nodiscard]] Hindrance hindranceOf(const ChunkStep& step, std::size_t e) noexcept;

/// Whether the candidate stands on a floor and penetrates nothing.
[[nodiscard]] inline bool isFree(const ChunkStep& step, std::size_t e) noexcept {
  return hindranceOf(step, e) == Hindrance::kNone;
}

/// What the floor under its base hinders the candidate by, if it does.
[[nodiscard]] Hindrance hindranceByFloor(const ChunkStep& step, std::size_t e) noexcept;

/// Asks maps about what the candidate holds, if anything.
void lookAtHeld(const ChunkStep& step, std::size_t e) noexcept;

/// What hinders the candidate, if neither the floor nor the scene hinders the robot itself. What it
/// holds has been looked at.
[[nodiscard]] Hindrance hindranceByObjects(const ChunkStep& step, std::size_t e) noexcept;

/// Asks maps and slices about all candidates of a chunk at once, so that none waits for the answer
/// about another.
void lookAtAll(const ChunkStep& step) noexcept;

/// As hindranceOf(), where lookAtAll() has looked already.
[[nodiscard]] Hindrance hindranceAsSeen(const ChunkStep& step, std::size_t e) noexcept;

/// What the env's robot can hit.
[[nodiscard]] Obstacles obstaclesOf(const ChunkStep& step, std::size_t e) noexcept;

/// The spheres of the held object at the candidate's grip.
[[nodiscard]] SphereBatch heldSpheres(const ChunkStep& step, std::size_t e) noexcept;

/// Finds the robot's spheres that the scene blocks, in the chunk. Whether there is any.
bool findBlocked(const ChunkStep& step, std::size_t e) noexcept;

/// The same but for groups that are free. `free`: eight by eight, as bits.
bool findBlocked(const ChunkStep& step, std::size_t e, std::span<const unsigned> free) noexcept;

/// Whether all groups but those that are free anyway are free after a move, too: maps have said by
/// how much. `moved`: since they were asked.
[[nodiscard]] bool isSureAfter(const ChunkStep& step, std::size_t e, const Push& moved,
                               std::span<const unsigned> free) noexcept;

/// Finds where the spheres of some groups of an eight are, in the chunk. What slices say of them.
InSlices findPlaces(const ChunkStep& step, std::size_t e, std::size_t eight,
                    unsigned groups) noexcept;

/// Whether the last look at what the candidate holds says that all its spheres are free.
[[nodiscard]] bool heldIsSurelyFree(const ChunkStep& step, std::size_t e) noexcept;

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

}  // namespace galactic::simulation
