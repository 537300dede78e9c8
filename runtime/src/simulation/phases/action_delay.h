#pragma once
#include <cstddef>
#include <span>

#include "simulation/phases/chunk.h"

namespace galactic::simulation {

/// Nothing is under way to the robot of an env: its episode begins.
void beginDelay(BatchState& state, std::size_t n) noexcept;

/// Keeps the actions of a chunk for when they arrive, and lets those arrive that are due. Only
/// where there is delay.
void delayActions(const ChunkStep& step) noexcept;

/// What reaches the robots of a chunk: the actions themselves, unless these are late. Where none
/// has arrived yet, motions are 0, and hand and terminate no numbers, which reach no threshold.
[[nodiscard]] std::span<const EnvRow> arrivedOf(const ChunkStep& step) noexcept;

}  // namespace galactic::simulation
