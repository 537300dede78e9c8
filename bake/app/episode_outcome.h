#pragma once
#include <cstdint>
#include <filesystem>
#include <string>

#include "bake_run.h"
#include "galactic/bake/source_episodes.h"

namespace galactic::bake {

/// What became of one set of episodes.
struct EpisodeOutcome {
  /// What it was made from, for people.
  std::string input;
  std::filesystem::path output;
  SourceEpisodes episodes;
  /// Size of the pack; 0 for a dry run.
  std::uint64_t pack_bytes = 0;
  double seconds = 0;
};

/// Episodes, scenes, objects, distances from target to goal; with kVerbose the names.
void printEpisodeTable(const EpisodeOutcome& outcome, Verbosity verbosity);

/// The set's entry of the report.
[[nodiscard]] Json episodeReport(const EpisodeOutcome& outcome);

}  // namespace galactic::bake
