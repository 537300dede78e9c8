// In which order envs take episodes.
#include "simulation/state/episode_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

namespace galactic::test::episode_order_test {
namespace {

using namespace galactic::simulation;

std::vector<std::uint32_t> permutation(std::uint32_t count, std::uint64_t key) {
  std::vector<std::uint32_t> places(count);
  for (std::uint32_t n = 0; n < count; ++n) places[n] = permuted(n, count, key);
  return places;
}

std::vector<std::uint32_t> ascending(std::uint32_t count) {
  std::vector<std::uint32_t> places(count);
  std::iota(places.begin(), places.end(), 0U);
  return places;
}

/// The first `rounds` * `count` episodes of an env.
std::vector<std::uint32_t> episodesOf(const SimulationOptions& options, std::uint64_t env,
                                      std::uint32_t count, std::uint32_t rounds) {
  std::vector<std::uint32_t> episodes(std::size_t{rounds} * count);
  for (std::size_t nth = 0; nth < episodes.size(); ++nth) {
    episodes[nth] = nthEpisode(options, env, nth, count).value();
  }
  return episodes;
}

SimulationOptions optionsOf(EpisodeOrder order, std::uint32_t envs, std::uint32_t ranks) {
  SimulationOptions options;
  options.envs = envs;
  options.ranks = ranks;
  options.order = order;
  return options;
}

TEST(Permuted, TakesEachNumberOnceForEveryCount) {
  std::vector<std::uint32_t> counts = ascending(301);
  counts[0] = 100000;
  counts.insert(counts.end(), {1023, 1024, 1025, 4096, 65535, 65536, 65537});
  for (const std::uint32_t count : counts) {
    for (const std::uint64_t key : {0ULL, 1ULL, 0xFFFFFFFFFFFFFFFFULL}) {
      std::vector<std::uint32_t> places = permutation(count, key);
      std::sort(places.begin(), places.end());
      ASSERT_EQ(places, ascending(count)) << "count " << count << " key " << key;
    }
  }
}

TEST(Permuted, StaysBelowTheLargestCounts) {
  for (const std::uint32_t count : {0x7FFFFFFFU, 0x80000001U, 0xFFFFFFFFU}) {
    for (std::uint32_t n = 0; n < 1000; ++n) ASSERT_LT(permuted(count - 1 - n, count, 7), count);
  }
}

TEST(Permuted, DiffersFromKeyToKey) {
  std::vector<std::vector<std::uint32_t>> orders;
  orders.reserve(200);
  for (std::uint64_t key = 0; key < 200; ++key) orders.push_back(permutation(50, key));
  std::sort(orders.begin(), orders.end());
  EXPECT_EQ(std::adjacent_find(orders.begin(), orders.end()), orders.end());
}

TEST(Permuted, BringsEachNumberToEachPlaceAboutEquallyOften) {
  constexpr std::uint32_t kCount = 10;
  constexpr std::uint64_t kKeys = 20000;
  std::vector<std::uint32_t> seen(std::size_t{kCount} * kCount);
  for (std::uint64_t key = 0; key < kKeys; ++key) {
    for (std::uint32_t n = 0; n < kCount; ++n) ++seen[n * kCount + permuted(n, kCount, key)];
  }
  // No cipher: walking the cycles of so small a network favors some places by a fifth.
  for (const std::uint32_t times : seen) EXPECT_NEAR(times, 2000, 500);
}

TEST(EpisodeOrder, ShuffledTakesAllEpisodesOnceInEachRoundInAnotherOrder) {
  constexpr std::uint32_t kCount = 37;
  const std::vector<std::uint32_t> episodes = episodesOf({}, 5, kCount, 4);
  std::vector<std::vector<std::uint32_t>> rounds;
  for (auto first = episodes.begin(); first != episodes.end(); first += kCount) {
    rounds.emplace_back(first, first + kCount);
    std::vector<std::uint32_t> sorted = rounds.back();
    std::sort(sorted.begin(), sorted.end());
    EXPECT_EQ(sorted, ascending(kCount));
  }
  std::sort(rounds.begin(), rounds.end());
  EXPECT_EQ(std::adjacent_find(rounds.begin(), rounds.end()), rounds.end());
}

TEST(EpisodeOrder, ShuffledDependsOnSeedAndEnvOnly) {
  SimulationOptions options;
  const auto first = episodesOf(options, 3, 50, 2);
  EXPECT_NE(first, episodesOf(options, 4, 50, 2));
  options.envs = 4096;
  options.ranks = 8;
  options.rank = 7;
  options.threads = 3;
  EXPECT_EQ(first, episodesOf(options, 3, 50, 2));
  options.seed = 2;
  EXPECT_NE(first, episodesOf(options, 3, 50, 2));
}

TEST(EpisodeOrder, LinearBeginsWithTheEnvsOwnNumberWhateverTheBatch) {
  SimulationOptions options = optionsOf(EpisodeOrder::kLinear, 128, 1);
  EXPECT_EQ(episodesOf(options, 8, 5, 2),
            (std::vector<std::uint32_t>{3, 4, 0, 1, 2, 3, 4, 0, 1, 2}));
  const auto before = episodesOf(options, 8, 5, 2);
  options.envs = 1;
  options.seed = 9;
  EXPECT_EQ(before, episodesOf(options, 8, 5, 2));
}

TEST(EpisodeOrder, PartitionGivesEachEpisodeToOneEnvOfAllRanks) {
  const SimulationOptions options = optionsOf(EpisodeOrder::kPartition, 6, 2);
  std::vector<std::uint32_t> taken;
  for (std::uint64_t env = 0; env < 12; ++env) {
    for (std::uint64_t nth = 0; nth < 7; ++nth) {
      if (const auto episode = nthEpisode(options, env, nth, 57)) taken.push_back(*episode);
    }
  }
  std::sort(taken.begin(), taken.end());
  EXPECT_EQ(taken, ascending(57));
  EXPECT_EQ(nthEpisode(options, 8, 4, 57), 56U);
  EXPECT_FALSE(nthEpisode(options, 9, 4, 57));
  EXPECT_FALSE(nthEpisode(options, 8, ~std::uint64_t{0}, 57));
  EXPECT_EQ(nthEpisode(options, 7, 2, 60), 31U);
}

TEST(EpisodeOrder, NeverLeavesTheEpisodesHoweverLongItRuns) {
  for (const EpisodeOrder order : {EpisodeOrder::kShuffled, EpisodeOrder::kLinear}) {
    const SimulationOptions options = optionsOf(order, 4096, 64);
    for (std::uint64_t nth = 0; nth < 1000; ++nth) {
      ASSERT_LT(nthEpisode(options, 262143, nth * 4294967311ULL, 99).value(), 99U);
    }
    EXPECT_EQ(nthEpisode(options, 5, 12, 1), 0U);
  }
}

}  // namespace
}  // namespace galactic::test::episode_order_test
