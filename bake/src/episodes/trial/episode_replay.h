#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "galactic/bake/episode_set_import.h"
#include "galactic/error.h"
#include "galactic/pack.h"

namespace galactic::bake {

/// The result of replaying an episode in the runtime.
enum class ReplayEnd : std::uint8_t {
  kStands,   ///< It starts, and in a step without actions nothing moves.
  kBlocked,  ///< It does not start, or not where it should: the robot penetrates something.
  kMoved,    ///< Something moved in a step without actions.
};

/// Starts each episode in a BatchSimulator and takes one step without actions. `packs` are the
/// scene of the episodes, all objects and the robot. The result for an episode does not depend on
/// the others. Fails with the errors of World::from and BatchSimulator::create.
[[nodiscard]] Result<std::vector<ReplayEnd>> replayEpisodes(std::span<const PackFile* const> packs,
                                                            const SourceEpisodes& episodes);

}  // namespace galactic::bake
