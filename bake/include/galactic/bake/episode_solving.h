#pragma once
#include <cstdint>
#include <map>
#include <span>
#include <string>

#include "galactic/bake/source_episodes.h"
#include "galactic/error.h"
#include "galactic/pack.h"

namespace galactic::bake {

/// How a sample of episodes went.
struct SolvedSample {
  std::uint32_t episodes = 0;
  std::uint32_t solved = 0;
  /// How many of the others ended how: ScriptedTrouble's names, "out of time", "does not start".
  std::map<std::string, std::uint32_t> unsolved;
};

struct EpisodeSolvingOptions {
  /// How many episodes at most; they are evenly chosen.
  std::uint32_t most_episodes = 16;
  /// After this many steps an episode counts as unsolved.
  std::uint32_t most_steps = 1000;
  /// Threads; the result does not depend on it.
  unsigned jobs = 1;
};

/// Lets the ScriptedPolicy of the runtime play Rearrange in a sample of the episodes: what it does
/// not solve may be solvable nevertheless, but a low share says that something is wrong. `packs`:
/// scenes, objects and the robot of the episodes. Fails with the errors of World::from and
/// BatchSimulator::create.
[[nodiscard]] Result<SolvedSample> solveSample(std::span<const PackFile* const> packs,
                                               const SourceEpisodes& episodes,
                                               const EpisodeSolvingOptions& options);

}  // namespace galactic::bake
