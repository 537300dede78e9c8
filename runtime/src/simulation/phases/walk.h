#pragma once
#include <cstddef>
#include <cstdint>

#include "simulation/phases/chunk.h"

namespace galactic::simulation {

enum class Walk : std::uint8_t {
  /// Everything on the way is free, and the candidate, too.
  kStraight = 0,
  /// It slid along something, or stopped before something: the candidate is where it got to.
  kHindered = 1,
  /// There is not even a beginning of the way; the candidate is of no use.
  kNone = 2,
};

/// Moves a robot from its pose toward the candidate in parts so short that no sphere moves further
/// than its radius, and slides a little in each part where something blocks it: so it passes
/// through nothing. `step.between` must be there.
[[nodiscard]] Walk walkToCandidate(const ChunkStep& step, std::size_t e) noexcept;

}  // namespace galactic::simulation
