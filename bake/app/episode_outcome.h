#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bake_run.h"
#include "galactic/bake/episode_generator.h"
#include "galactic/bake/episode_solving.h"
#include "galactic/bake/source_episodes.h"

namespace galactic::bake {

/// How episodes were generated.
struct EpisodeGeneration {
  RejectionCounts rejections;
  std::vector<GeneratedScene> scenes;
  std::vector<UnusableScene> left_out;
  SolvedSample sample;
  std::uint32_t skipped = 0;
  std::uint32_t with_fewer_objects = 0;
};

/// What became of one set of episodes.
struct EpisodeOutcome {
  /// What it was made from, for people.
  std::string input;
  std::filesystem::path output;
  SourceEpisodes episodes;
  /// Of generated ones.
  std::optional<EpisodeGeneration> generation{};
  /// Size of the pack; 0 for a dry run.
  std::uint64_t pack_bytes = 0;
  double seconds = 0;
};

/// Episodes, scenes, objects, distances from target to goal, what was drawn and not taken; with
/// kVerbose the names and what was found in each scene.
void printEpisodeTable(const EpisodeOutcome& outcome, Verbosity verbosity);

/// The set's entry of the report.
[[nodiscard]] Json episodeReport(const EpisodeOutcome& outcome);

}  // namespace galactic::bake
