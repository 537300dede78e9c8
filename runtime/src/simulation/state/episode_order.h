#pragma once
#include <cstdint>
#include <optional>

#include "galactic/simulation_options.h"

namespace galactic::simulation {

/// A place of a permutation of `count` numbers, without storing the permutation: a Feistel network
/// over the next power of four, walked until the number is below `count`. `key` chooses the
/// permutation. index < count; 1 <= count.
[[nodiscard]] std::uint32_t permuted(std::uint32_t index, std::uint32_t count,
                                     std::uint64_t key) noexcept;

/// The `nth` episode that env `env` (counted over all ranks) begins, as an index below `count`.
/// None when the env has had its share, which ends with EpisodeOrder::kPartition alone.
[[nodiscard]] std::optional<std::uint32_t> nthEpisode(const SimulationOptions& options,
                                                      std::uint64_t env, std::uint64_t nth,
                                                      std::uint32_t count) noexcept;

}  // namespace galactic::simulation
