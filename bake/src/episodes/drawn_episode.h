#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "episodes/episode_draft.h"
#include "episodes/generation_world.h"
#include "galactic/bake/episode_generator.h"
#include "galactic/episode_set.h"

namespace galactic::bake {

/// The result of drawing one episode.
struct DrawnEpisode {
  /// Its number among all episodes.
  std::size_t number = 0;
  /// Seed of its own stream of random numbers, so that no episode depends on another.
  std::uint64_t seed = 0;
  /// Whether no place was found for it.
  bool is_skipped = false;
  std::uint32_t drafts = 0;
  std::uint32_t replays_failed = 0;
  /// Number of drafts that ended at each part.
  std::array<std::uint32_t, kDraftEnds> ends{};
  RejectionCounts rejections{};
  /// As in a set in which it is the first episode; its scene is not set.
  Episode episode{};
  std::vector<Placement> placements{};
};

/// Sets where the robot starts.
void setStart(const RobotStart& start, Episode& episode);

/// Copies a draft into the episode.
void setDraft(const DraftedEpisode& draft, DrawnEpisode& episode);

/// A set with names but without episodes.
[[nodiscard]] SourceEpisodes emptySet(const GenerationWorld& world,
                                      std::span<const SceneOfPack* const> scenes);

/// Adds an episode; `scene` is the number of its scene in the set.
void append(const DrawnEpisode& drawn, std::uint32_t scene, SourceEpisodes& episodes);

}  // namespace galactic::bake
