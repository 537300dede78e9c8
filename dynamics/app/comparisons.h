#pragma once
#include <vector>

#include "command_line.h"
#include "dynamics/episodes/comparison.h"
#include "dynamics/episodes/episode_source.h"
#include "dynamics/report/journal.h"
#include "galactic/error.h"
#include "support/console/stop_request.h"

namespace galactic::dynamics {

/// Compares all episodes. `journal`: keeps finished episodes; may be null. The result does not
/// depend on the number of threads. After a stop request, it finishes the episodes that have begun,
/// and returns fewer than episodes.count(). Fails with the error of compareEpisode for the first
/// episode that fails.
[[nodiscard]] Result<std::vector<EpisodeComparison>> compareAll(const EpisodeSource& episodes,
                                                                const ComparisonWorlds& worlds,
                                                                const Command& command,
                                                                const StopRequest& stop,
                                                                ComparisonJournal* journal);

}  // namespace galactic::dynamics
