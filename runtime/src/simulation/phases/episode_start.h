#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include "simulation/phases/chunk.h"
#include "simulation/state/batch_state.h"
#include "simulation/state/model.h"

namespace galactic::simulation {

/// What follows from the rest of an env's state: the distances that are left, and its observation.
void takeStock(const Model& model, BatchState& state, std::size_t env) noexcept;

/// Env `env` stands at the start `start` (index into Model::starts) and its observation is written.
void beginEpisode(const Model& model, BatchState& state, std::size_t env, std::uint32_t start,
                  EpisodeChoice choice) noexcept;
/// The same at the start of the episode that is the env's next. Without one it is idle from now on,
/// and stays as it is: see BatchSimulator::idle().
void beginNextEpisode(const Model& model, BatchState& state, std::size_t env) noexcept;

/// Where the episode ended: keeps the last observation and begins the next one or, without
/// auto_reset, leaves the env idle.
void renewEpisodes(const ChunkStep& step) noexcept;

/// Begins the episodes that the caller asks for: for each env of the batch an index into the
/// world's episodes. Numbers without a start (Model::startOf) begin none.
void resetEpisodes(const ChunkStep& step, std::span<const std::int32_t> resets) noexcept;

}  // namespace galactic::simulation
