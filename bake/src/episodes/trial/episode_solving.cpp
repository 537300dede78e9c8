#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "episodes/trial/memory_world.h"
#include "galactic/bake/episode_generator.h"
#include "galactic/bake/parallel_for.h"
#include "galactic/batch_simulator.h"
#include "scripted/scripted_policy.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

/// A set with only one of the episodes.
SourceEpisodes alone(const SourceEpisodes& all, std::size_t number) {
  SourceEpisodes set;
  set.name = all.name;
  set.robot = all.robot;
  set.scenes = all.scenes;
  set.objects = all.objects;
  set.start_joints = all.start_joints;
  Episode episode = all.episodes[number];
  const auto first = all.placements.begin() + episode.first_placement;
  set.placements.assign(first, first + episode.placement_count);
  episode.first_placement = 0;
  const std::size_t joints = all.start_joints.size();
  const auto start = all.start_positions.begin() + static_cast<std::ptrdiff_t>(number * joints);
  set.start_positions.assign(start, start + static_cast<std::ptrdiff_t>(joints));
  set.episodes.push_back(episode);
  return set;
}

/// How an episode failed; empty if it was solved.
using Outcome = std::string;

Result<Outcome> play(const World& world, std::uint32_t most_steps) {
  SimulationOptions options;
  options.envs = 1;
  options.threads = 1;
  options.task.most_steps = most_steps;
  auto simulator = BatchSimulator::create(world, options);
  if (!simulator) {
    if (simulator.error().name == kNoEpisodeStarts) return Outcome("does not start");
    return tl::unexpected(simulator.error());
  }
  ASSIGN_OR_RETURN(auto policy, ScriptedPolicy::create(world, options));
  std::vector<float> actions(simulator->actionCount());
  do {
    policy.act(*simulator, actions);
    simulator->step(actions);
  } while (simulator->dones()[0] == 0);
  if (simulator->successes()[0] != 0) return Outcome();
  const ScriptedTrouble trouble = policy.trouble(0);
  return trouble == ScriptedTrouble::kNone ? Outcome("out of time") : Outcome(nameOf(trouble));
}

}  // namespace

Result<SolvedSample> solveSample(std::span<const PackFile* const> packs,
                                 const SourceEpisodes& episodes,
                                 const EpisodeSolvingOptions& options, unsigned threads) {
  const std::size_t all = episodes.episodes.size();
  const std::size_t count = std::min<std::size_t>(options.most_episodes, all);
  std::vector<Result<Outcome>> outcomes(count);
  parallelFor(threads, count, [&](std::size_t n) {
    const auto world = MemoryWorld::open(packs, alone(episodes, n * all / count));
    outcomes[n] = world ? play(**world, options.most_steps) : tl::unexpected(world.error());
  });
  SolvedSample sample;
  sample.episodes = static_cast<std::uint32_t>(count);
  for (const Result<Outcome>& outcome : outcomes) {
    if (!outcome) return tl::unexpected(outcome.error());
    if (outcome->empty()) {
      ++sample.solved;
    } else {
      ++sample.unsolved[*outcome];
    }
  }
  return sample;
}

}  // namespace galactic::bake
