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

/// What became of one episode.
struct DrawnEpisode {
  /// Which one of all.
  std::size_t number = 0;
  /// Of its own stream of random numbers, so that no episode depends on another.
  std::uint64_t seed = 0;
  /// Whether it found no place.
  bool is_skipped = false;
  std::uint32_t drafts = 0;
  std::uint32_t replays_failed = 0;
  /// How many drafts ended at each part.
  std::array<std::uint32_t, kDraftEnds> ends{};
  RejectionCounts rejections{};
  /// As in a set of which it is the first; its scene is not said.
  Episode episode{};
  std::vector<Placement> placements{};
};

/// Puts the robot where it starts.
void setStart(const RobotStart& start, Episode& episode);

/// Takes over what was drafted.
void setDraft(const DraftedEpisode& draft, DrawnEpisode& episode);

/// Names, but no episodes.
[[nodiscard]] SourceEpisodes emptySet(const GenerationWorld& world,
                                      std::span<const SceneOfPack* const> scenes);

/// Adds an episode in the scene of that number.
void append(const DrawnEpisode& drawn, std::uint32_t scene, SourceEpisodes& episodes);

}  // namespace galactic::bake
