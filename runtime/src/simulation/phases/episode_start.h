#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include "simulation/phases/chunk.h"
#include "simulation/state/batch_state.h"
#include "simulation/state/model.h"

namespace galactic::simulation {

/// Computes what follows from the rest of an env's state: the remaining distances, and its
/// observation.
void takeStock(const Model& model, BatchState& state, std::size_t env) noexcept;

/// Puts env `env` at the start `start` (index into Model::starts) and writes its observation.
void beginEpisode(const Model& model, BatchState& state, std::size_t env, std::uint32_t start,
                  EpisodeChoice choice) noexcept;
/// The same with the env's next episode. If there is none, the env becomes idle and stays as it is:
/// see BatchSimulator::idle().
void beginNextEpisode(const Model& model, BatchState& state, std::size_t env) noexcept;

/// For each env whose episode has ended: keeps the last observation, then begins the next episode
/// or, without auto_reset, leaves the env idle.
void renewEpisodes(const ChunkStep& step) noexcept;

/// Begins the episodes that the caller asks for. `resets`: for each env of the batch an index into
/// the world's episodes; a number without a start (Model::startOf) begins none.
void resetEpisodes(const ChunkStep& step, std::span<const std::int32_t> resets) noexcept;

}  // namespace galactic::simulation
