#pragma once
#include <cstdint>
#include <optional>

#include "galactic/simulation_options.h"

namespace galactic::simulation {

/// Element `index` of a permutation of `count` numbers that is not stored: a Feistel network over
/// the next power of four, applied until the number is below `count`. `key` chooses the
/// permutation. index < count; 1 <= count.
[[nodiscard]] std::uint32_t permuted(std::uint32_t index, std::uint32_t count,
                                     std::uint64_t key) noexcept;

/// The `nth` episode that env `env` (counted over all ranks) begins, as an index below `count`.
/// None if the env has played its whole share; only EpisodeOrder::kPartition has shares that end.
[[nodiscard]] std::optional<std::uint32_t> nthEpisode(const SimulationOptions& options,
                                                      std::uint64_t env, std::uint64_t nth,
                                                      std::uint32_t count) noexcept;

}  // namespace galactic::simulation
