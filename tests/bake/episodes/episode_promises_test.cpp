// What is asked of thousands of generated episodes, by an oracle that knows nothing of the
// generator. What few episodes show as well is asked in sample_world_test.cpp.
#include <gtest/gtest.h>

#include <functional>

#include "episode_oracle.h"
#include "sample_packs.h"

namespace galactic::test::episode_promises_test {
namespace {

using bake::DistanceRange;
using bake::EpisodeGeneratorOptions;
using bake::SourceEpisodes;

/// Distances are rounded to floats, and the base's height is left out of them.
constexpr double kRounding = 1e-4;

bool isWithin(double distance, const DistanceRange& range) {
  return distance >= static_cast<double>(range.least) - kRounding &&
         distance <= static_cast<double>(range.most) + kRounding;
}

double startDistance(const SourceEpisodes& set, const Episode& episode) {
  const Vec3& target = set.placements[episode.first_placement + episode.target].pose.translation;
  return std::hypot(static_cast<double>(target.x - episode.base_position.x),
                    static_cast<double>(target.z - episode.base_position.z));
}

TEST(PromisesOfManyEpisodes, AreKeptWithEveryOption) {
  const SampleWorld world;
  EpisodeGeneratorOptions options;
  options.episodes = 2000;
  options.objects = {2, 6};
  options.heights = {0.5F, 1.0F};
  options.target_to_goal = {1.5F, 4.0F};
  options.start_to_target = {1.0F, 3.0F};
  options.goal_on_other_support = true;
  bake::EpisodeInputs inputs = world.inputs();
  inputs.threads = 2;
  const auto made = MemoryPack::opened(bake::generateEpisodes(inputs, options));
  const SourceEpisodes& set = made.episodes;
  ASSERT_EQ(set.episodes.size(), options.episodes);
  const EpisodeOracle oracle(world.scenes.front(), world.objects, world.robot, options);
  std::vector<std::size_t> counts(options.objects.most + 1, 0);
  // The shelves and tables that hold targets, told apart by their height in centimeters.
  std::set<long> heights;
  for (std::size_t n = 0; n < set.episodes.size(); ++n) {
    const Episode& episode = set.episodes[n];
    ASSERT_GE(episode.placement_count, options.objects.least);
    ASSERT_LE(episode.placement_count, options.objects.most);
    ++counts[episode.placement_count];
    EXPECT_TRUE(isWithin(oracle.travel(set, episode), options.target_to_goal)) << n;
    EXPECT_TRUE(isWithin(startDistance(set, episode), options.start_to_target)) << n;
    EXPECT_TRUE(oracle.startsFree(set, episode)) << n;
    heights.insert(std::lround(episode.goal.translation.y * 100));
    // Each asks some thousand columns, or hundreds of projections.
    if (n % 16 != 0) continue;
    EXPECT_TRUE(oracle.allStand(set, episode)) << n;
    EXPECT_TRUE(oracle.isApart(set, episode)) << n;
  }
  for (std::size_t n = options.objects.least; n <= options.objects.most; ++n) {
    EXPECT_GT(counts[n], options.episodes / 10) << n << " objects";
  }
  EXPECT_GT(heights.size(), 3U);
  EXPECT_GT(made.rejections[bake::EpisodeRejection::kSameSupport], 0U);
  EXPECT_GT(made.rejections[bake::EpisodeRejection::kDistance], 0U);
  EXPECT_GT(made.rejections[bake::EpisodeRejection::kStartDistance], 0U);
  EXPECT_GT(made.rejections[bake::EpisodeRejection::kNoRoom], 0U);

  // Without these options the promises would not hold: the oracle can say no.
  EpisodeGeneratorOptions free = options;
  free.episodes = 500;
  free.target_to_goal = {};
  free.start_to_target = {};
  const auto other = MemoryPack::opened(bake::generateEpisodes(world.inputs(), free)).episodes;
  int far = 0;
  int away = 0;
  for (const Episode& episode : other.episodes) {
    if (!isWithin(oracle.travel(other, episode), options.target_to_goal)) ++far;
    if (!isWithin(startDistance(other, episode), options.start_to_target)) ++away;
  }
  EXPECT_GT(far, 50);
  EXPECT_LT(far, 450);
  EXPECT_GT(away, 50);
  EXPECT_LT(away, 450);
}

}  // namespace
}  // namespace galactic::test::episode_promises_test
