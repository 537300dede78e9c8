#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "simulation/collision/collision.h"
#include "simulation/phases/chunk.h"

namespace galactic::simulation {

/// Whether the candidate of the chunk's env `e` stands on a floor and penetrates nothing. What it
/// found on the way stays in the chunk.
[[nodiscard]] bool isFree(const ChunkStep& step, std::size_t e) noexcept;

/// Whether the candidate penetrates no object, nor what it holds anything.
[[nodiscard]] bool isFreeOfObjects(const ChunkStep& step, std::size_t e) noexcept;

/// Asks maps and slices about all candidates of a chunk at once, so that none waits for the answer
/// about another.
void lookAtAll(const ChunkStep& step) noexcept;

/// As isFree(), where lookAtAll() has looked already.
[[nodiscard]] bool isFreeAsSeen(const ChunkStep& step, std::size_t e) noexcept;

/// What the env's robot can hit.
[[nodiscard]] Obstacles obstaclesOf(const ChunkStep& step, std::size_t e) noexcept;

/// The spheres of the held object at the candidate's grip.
[[nodiscard]] SphereBatch heldSpheres(const ChunkStep& step, std::size_t e) noexcept;

/// Whether a move to where groups that suit it are free leaves all others free, too: the scene's
/// maps have said by how much. `moved`: since they were asked.
[[nodiscard]] bool isSureAfter(const ChunkStep& step, std::size_t e, const Push& moved) noexcept;

/// Finds the robot's spheres that the scene blocks, in the chunk's bits, except those of groups
/// that suit a move. Whether there is any.
bool findBlocked(const ChunkStep& step, std::size_t e) noexcept;

/// Finds where the spheres of some groups of an eight are, in the chunk. What slices say of them.
InSlices findPlaces(const ChunkStep& step, std::size_t e, std::size_t eight,
                    unsigned groups) noexcept;

/// Whether a look at the ball around the held object's spheres says that all are free.
[[nodiscard]] bool heldIsSurelyFree(const ChunkStep& step, std::size_t e) noexcept;

[[nodiscard]] inline bool isEmpty(std::span<const std::uint64_t> bits) {
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

}  // namespace galactic::simulation
