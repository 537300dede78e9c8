#pragma once
#include <vector>

#include "command_line.h"
#include "dynamics/episodes/comparison.h"
#include "dynamics/episodes/episode_source.h"
#include "dynamics/report/journal.h"
#include "galactic/error.h"
#include "support/console/stop_request.h"

namespace galactic::dynamics {

/// Compares all episodes. `journal`: keeps what is done; null: nobody does. The result does not
/// depend on the number of threads. When `stop` came it finishes what has begun, and returns fewer
/// than episodes.count(). Fails with the errors of compareEpisode, of the first episode that fails.
[[nodiscard]] Result<std::vector<EpisodeComparison>> compareAll(const EpisodeSource& episodes,
                                                                const ComparisonWorlds& worlds,
                                                                const Command& command,
                                                                const StopRequest& stop,
                                                                ComparisonJournal* journal);

}  // namespace galactic::dynamics
