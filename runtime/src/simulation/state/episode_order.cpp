#include "simulation/state/episode_order.h"

#include <bit>

#include "support/random_stream.h"

namespace galactic::simulation {

std::uint32_t permuted(std::uint32_t index, std::uint32_t count, std::uint64_t key) noexcept {
  const unsigned half_bits = count <= 1 ? 1U : (std::bit_width(count - 1) + 1U) / 2U;
  const std::uint64_t half_mask = (std::uint64_t{1} << half_bits) - 1;
  constexpr std::uint64_t kRounds = 4;
  std::uint64_t value = index;
  // The permutation's cycle through a number below `count` returns to it, so the loop ends.
  do {
    std::uint64_t left = value >> half_bits;
    std::uint64_t right = value & half_mask;
    for (std::uint64_t round = 0; round < kRounds; ++round) {
      const std::uint64_t next = left ^ (mix(mix(key ^ round) ^ right) & half_mask);
      left = right;
      right = next;
    }
    value = (left << half_bits) | right;
  } while (value >= count);
  return static_cast<std::uint32_t>(value);
}

std::optional<std::uint32_t> nthEpisode(const SimulationOptions& options, std::uint64_t env,
                                        std::uint64_t nth, std::uint32_t count) noexcept {
  switch (options.order) {
    case EpisodeOrder::kLinear:
      return static_cast<std::uint32_t>((env + nth) % count);
    case EpisodeOrder::kPartition: {
      const std::uint64_t envs = std::uint64_t{options.envs} * options.ranks;
      if (env >= count || nth > (count - 1 - env) / envs) return std::nullopt;
      return static_cast<std::uint32_t>(env + nth * envs);
    }
    case EpisodeOrder::kShuffled:
      break;
  }
  const std::uint64_t key = mix(mix(mix(options.seed) ^ env) ^ (nth / count));
  return permuted(static_cast<std::uint32_t>(nth % count), count, key);
}

}  // namespace galactic::simulation
