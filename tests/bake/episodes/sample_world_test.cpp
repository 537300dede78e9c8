// The generator on the project's own world: every promise of every episode, by brute force.
#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <string>

#include "episode_oracle.h"
#include "galactic/bake/episode_generator.h"
#include "sample_packs.h"

namespace galactic::test::sample_world_test {
namespace {

/// Counts how often a question is answered with yes.
class Tally {
 public:
  void add(bool yes) {
    ++asked_;
    if (yes) ++yes_;
  }
  [[nodiscard]] double share() const { return static_cast<double>(yes_) / asked_; }
  [[nodiscard]] bool isTwoSided() const { return share() >= 0.1 && share() <= 0.9; }

 private:
  double asked_ = 0;
  int yes_ = 0;
};

bake::SourceEpisodes generated(const SampleWorld& world,
                               const bake::EpisodeGeneratorOptions& options) {
  return MemoryPack::opened(bake::generateEpisodes(world.inputs(), options)).episodes;
}

/// Grasp points of random arm positions, above the ground and away from the base.
void expectReach(const Robot& robot) {
  std::mt19937 random(7);
  std::vector<float> positions(robot.startPositions().begin(), robot.startPositions().end());
  // Floor, table and shelf, beyond the base's edge.
  const std::vector<double> heights{0.03, 0.75, 1.0, 1.2};
  std::vector<int> hits(heights.size(), 0);
  for (int n = 0; n < 20000; ++n) {
    for (const ControlledJoint& joint : robot.controlledJoints()) {
      const double lower = std::max(static_cast<double>(joint.lower), -std::numbers::pi);
      const double upper = std::min(static_cast<double>(joint.upper), std::numbers::pi);
      positions[joint.position] = static_cast<float>(lower + uniform(random) * (upper - lower));
    }
    const Point p = oracleBody(robot, positions).grasp_point;
    for (std::size_t h = 0; h < heights.size(); ++h) {
      if (std::abs(p[1] - heights[h]) < 0.02 && p[0] > 0.45) ++hits[h];
    }
  }
  for (std::size_t h = 0; h < heights.size(); ++h) EXPECT_GT(hits[h], 0) << heights[h] << " m";
}

void expectSame(const bake::SourceEpisodes& a, const bake::SourceEpisodes& b) {
  ASSERT_EQ(a.placements.size(), b.placements.size());
  ASSERT_EQ(a.episodes.size(), b.episodes.size());
  for (std::size_t n = 0; n < a.placements.size(); ++n) {
    EXPECT_EQ(a.placements[n].object, b.placements[n].object);
    EXPECT_EQ(a.placements[n].pose, b.placements[n].pose);
  }
  for (std::size_t n = 0; n < a.episodes.size(); ++n) {
    EXPECT_EQ(a.episodes[n].target, b.episodes[n].target);
    EXPECT_EQ(a.episodes[n].base_position, b.episodes[n].base_position);
    EXPECT_EQ(a.episodes[n].base_yaw, b.episodes[n].base_yaw);
    EXPECT_EQ(a.episodes[n].goal, b.episodes[n].goal);
  }
}

/// Asks a question of each episode, then of one that breaks the promise.
void expectPromise(const char* promise, const bake::SourceEpisodes& set,
                   const std::function<bool(const bake::SourceEpisodes&, const Episode&)>& holds,
                   const std::function<void(bake::SourceEpisodes&, Episode&)>& spoil) {
  Tally tally;
  for (std::size_t n = 0; n < set.episodes.size(); ++n) {
    const bool kept = holds(set, set.episodes[n]);
    EXPECT_TRUE(kept) << promise << ": episode " << n;
    tally.add(kept);
    bake::SourceEpisodes spoiled = set;
    spoil(spoiled, spoiled.episodes[n]);
    tally.add(holds(spoiled, spoiled.episodes[n]));
  }
  EXPECT_TRUE(tally.isTwoSided()) << promise << ": " << tally.share();
}

TEST(EpisodesOfTheSampleWorld, KeepEveryPromise) {
  const SampleWorld world;
  expectReach(world.robot);
  bake::EpisodeGeneratorOptions options;
  options.episodes = 30;
  const bake::SourceEpisodes set = generated(world, options);
  ASSERT_EQ(set.episodes.size(), options.episodes);
  EXPECT_EQ(set.robot, "porter");
  EXPECT_TRUE(set.start_joints.empty());
  EXPECT_EQ(set.objects.size(), world.objects.objects().size());
  EpisodeOracle oracle(world.scenes.front(), world.objects, world.robot, options);

  using Set = bake::SourceEpisodes;
  const auto target = [](Set& spoiled, const Episode& episode) -> Placement& {
    return spoiled.placements[episode.first_placement + episode.target];
  };
  expectPromise(
      "objects keep apart", set,
      [&](const Set& s, const Episode& e) { return oracle.isApart(s, e); },
      [&](Set& s, Episode& e) {
        const std::uint32_t other = e.target == 0 ? 1 : 0;
        e.goal = s.placements[e.first_placement + other].pose;
        e.goal.translation.y += 0.01F;
      });
  expectPromise(
      "objects stand on surfaces", set,
      [&](const Set& s, const Episode& e) { return oracle.allStand(s, e); },
      [&](Set& s, Episode& e) { target(s, e).pose.translation.y += 0.02F; });
  expectPromise(
      "goals are places, too", set,
      [&](const Set& s, const Episode& e) { return oracle.allStand(s, e); },
      [&](Set&, Episode& e) { e.goal.translation.x += 0.3F; });
  expectPromise(
      "the robot starts free", set,
      [&](const Set& s, const Episode& e) { return oracle.startsFree(s, e); },
      [&](Set&, Episode& e) {
        e.base_position.x = -e.base_position.x;
        e.base_position.z = -e.base_position.z;
      });
  expectPromise(
      "the goal is away", set,
      [&](const Set& s, const Episode& e) {
        return oracle.travel(s, e) >= static_cast<double>(options.target_to_goal.least) - 1e-5;
      },
      [&](Set& s, Episode& e) { e.goal = target(s, e).pose; });
  expectPromise(
      "the target is within reach", set,
      [&](const Set& s, const Episode& e) { return oracle.isReached(s, e, false); },
      [&](Set& s, Episode& e) { target(s, e).pose.translation.y += 1.5F; });
  expectPromise(
      "the goal is within reach", set,
      [&](const Set& s, const Episode& e) { return oracle.isReached(s, e, true); },
      [&](Set&, Episode& e) { e.goal.translation.y += 1.5F; });

  // Most of the floor tried is no place to stand: the start could have been wrong.
  const double stands = static_cast<double>(oracle.floor().placesOnLargestPart()) /
                        static_cast<double>(oracle.floor().placesTried());
  EXPECT_GT(stands, 0.1);
  EXPECT_LT(stands, 0.9);

  // The same again, alone or as the beginning of more.
  expectSame(generated(world, options), set);
  bake::EpisodeGeneratorOptions other = options;
  other.episodes = 31;
  bake::SourceEpisodes longer = generated(world, other);
  longer.episodes.pop_back();
  longer.placements.resize(set.placements.size());
  expectSame(longer, set);
  other = options;
  other.seed = 2;
  EXPECT_NE(generated(world, other).episodes.front().base_position,
            set.episodes.front().base_position);
}

TEST(SolvedSamples, TellEpisodesThatCanBeSolvedFromThoseThatCannot) {
  const SampleWorld world;
  bake::EpisodeGeneratorOptions options;
  options.episodes = 8;
  options.objects = {3, 3};
  bake::SourceEpisodes set = generated(world, options);
  const auto solve = [&](const bake::EpisodeSolvingOptions& how, unsigned threads = 1) {
    const auto sample = bake::solveSample(world.inputs().packs, set, how, threads);
    EXPECT_TRUE(sample.has_value());
    return sample.value_or(bake::SolvedSample{});
  };
  const bake::SolvedSample all = solve({.most_episodes = 100});
  EXPECT_EQ(all.episodes, 8U);
  EXPECT_EQ(all.solved, 8U);
  EXPECT_TRUE(all.unsolved.empty());
  EXPECT_EQ(solve({.most_steps = 5}).unsolved,
            (std::map<std::string, std::uint32_t>{{"out of time", 8U}}));

  // A goal that no arm reaches, and a robot that stands outside of the scene.
  set.episodes[0].goal.translation.y += 1.5F;
  set.episodes[3].goal.translation.y += 1.5F;
  set.episodes[4].base_position.x = 500;
  const std::map<std::string, std::uint32_t> ends{{"does not start", 1U}, {"no placement", 2U}};
  for (const unsigned threads : {1U, 3U}) {
    const bake::SolvedSample spoiled = solve({.most_episodes = 8}, threads);
    EXPECT_EQ(spoiled.solved, 5U);
    EXPECT_EQ(spoiled.unsolved, ends);
  }
  // What is wrong with the options is no end of an episode.
  const auto wrong = bake::solveSample(world.inputs().packs, set, {.most_steps = 2'000'000'000});
  ASSERT_FALSE(wrong.has_value());
  EXPECT_EQ(wrong.error().text(),
            "simulation options: episode-steps is 2000000000, expected 0 to 1073741824");
  // Evenly chosen: 0, 2, 4 and 6.
  EXPECT_EQ(solve({.most_episodes = 4}).solved, 2U);
  EXPECT_EQ(solve({.most_episodes = 0}).episodes, 0U);
}

}  // namespace
}  // namespace galactic::test::sample_world_test
