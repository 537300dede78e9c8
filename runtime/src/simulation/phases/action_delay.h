#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "simulation/phases/chunk.h"

namespace galactic::simulation {

/// Clears the actions on their way to the robot of an env, whose episode begins.
void beginDelay(const Model& model, BatchState& state, std::size_t n) noexcept;

/// Lets the due actions of a chunk arrive if actions are delayed, and stores the current ones if
/// later steps need them.
void keepActions(const ChunkStep& step) noexcept;

/// The actions that reach the robots of a chunk in this step: the current ones, unless actions are
/// delayed. Before the first action arrives, motions are 0, and the hand and terminate actions are
/// NaN, which exceeds no threshold.
[[nodiscard]] std::span<const EnvRow> arrivedOf(const ChunkStep& step) noexcept;

/// The actions that were requested of an env and have not reached it yet; see
/// BatchSimulator::actionsUnderWay(). Allocates.
[[nodiscard]] std::vector<float> actionsUnderWay(const Model& model, const BatchState& state,
                                                 std::size_t n);

}  // namespace galactic::simulation
