#pragma once
#include <cstddef>
#include <cstdint>

#include "simulation/phases/chunk.h"

namespace galactic::simulation {

enum class Walk : std::uint8_t {
  /// The candidate and the whole way to it are free.
  kStraight = 0,
  /// The robot slid along something, or stopped in front of something: the candidate is the place
  /// that it reached.
  kHindered = 1,
  /// Not even the first part of the way is possible; the candidate is of no use.
  kNone = 2,
};

/// Moves a robot from its pose toward the candidate in parts so short that no sphere moves further
/// than its radius, and slides it a little in each part in which something blocks it, so that it
/// passes through nothing. `step.between` must not be null.
[[nodiscard]] Walk walkToCandidate(const ChunkStep& step, std::size_t e) noexcept;

}  // namespace galactic::simulation
