#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "galactic/bake/episode_set_import.h"
#include "galactic/error.h"
#include "galactic/pack.h"

namespace galactic::bake {

/// What the runtime made of an episode.
enum class ReplayEnd : std::uint8_t {
  kStands,   ///< It starts, and in a step without actions nothing moves.
  kBlocked,  ///< It does not start, or elsewhere: the robot penetrates something.
  kMoved,    ///< In a step without actions something moved.
};

/// Starts each episode in a BatchSimulator and takes one step without actions. `packs`: the scene
/// of the episodes, all objects, the robot. The answer for one episode does not depend on the
/// others. Fails with the errors of World::from and BatchSimulator::create.
[[nodiscard]] Result<std::vector<ReplayEnd>> replayEpisodes(std::span<const PackFile* const> packs,
                                                            const SourceEpisodes& episodes);

}  // namespace galactic::bake
