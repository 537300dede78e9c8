#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "simulation/phases/chunk.h"

namespace galactic::simulation {

/// Nothing is under way to the robot of an env: its episode begins.
void beginDelay(const Model& model, BatchState& state, std::size_t n) noexcept;

/// Lets those actions of a chunk arrive that are due, where they may be late, and keeps those that
/// are asked for now, where they are wanted later.
void keepActions(const ChunkStep& step) noexcept;

/// What reaches the robots of a chunk: the actions themselves, unless these are late. Where none
/// has arrived yet, motions are 0, and hand and terminate no numbers, which reach no threshold.
[[nodiscard]] std::span<const EnvRow> arrivedOf(const ChunkStep& step) noexcept;

/// What an env was asked to do and has not done yet: BatchSimulator::actionsUnderWay(). Allocates.
[[nodiscard]] std::vector<float> actionsUnderWay(const Model& model, const BatchState& state,
                                                 std::size_t n);

}  // namespace galactic::simulation
