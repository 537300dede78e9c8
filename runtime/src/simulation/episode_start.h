#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include "simulation/batch_state.h"
#include "simulation/chunk.h"
#include "simulation/model.h"

namespace galactic::simulation {

/// Env `env` stands at the start `start` (index into Model::starts) and its observation is written.
void beginEpisode(const Model& model, BatchState& state, std::size_t env,
                  std::uint32_t start) noexcept;

/// Where the episode ended: keeps the last observation and begins the next one.
void renewEpisodes(const ChunkStep& step) noexcept;

/// Begins the episodes that the caller asks for: for each env of the batch an index into the
/// world's episodes, or -1. An episode that cannot be started is passed over for the next one that
/// can.
void resetEpisodes(const ChunkStep& step, std::span<const std::int32_t> resets) noexcept;

}  // namespace galactic::simulation
