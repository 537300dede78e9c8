#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "dynamics/episodes/comparison.h"
#include "dynamics/episodes/episode_source.h"
#include "dynamics/report/report.h"
#include "galactic/error.h"

namespace galactic::dynamics {

/// The files that show both worlds side by side; empty paths are not written.
struct SideBySideFiles {
  /// A page that plays the episodes of the worst moments; each world shows the other as a ghost.
  std::filesystem::path view;
  /// A sheet (PNG) of the worst moments: the simulation on the left, the dynamics on the right.
  std::filesystem::path pictures;
};

/// What writeSideBySide() needs. All of it must outlive the call.
struct SideBySideParts {
  const Comparisons& comparisons;
  const ComparisonWorlds& worlds;
  /// The episodes that were compared.
  const EpisodeSource& episodes;
  const ReportSubject& subject;
};

/// Plays the episodes of the worst moments again and writes the requested files. If there is no
/// such moment, the page has the first episodes, and there are no pictures. Returns a sentence for
/// each file that is not written. Fails with kIo and the errors of policies, pages and renderers.
[[nodiscard]] Result<std::vector<std::string>> writeSideBySide(const SideBySideParts& parts,
                                                               const SideBySideFiles& files);

}  // namespace galactic::dynamics
