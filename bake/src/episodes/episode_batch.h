#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "episodes/drawn_episode.h"
#include "episodes/home/prepared_scene.h"
#include "galactic/error.h"

namespace galactic::bake {

/// Draws a batch of episodes in a scene and replays them, until all succeed or are skipped.
class EpisodeBatch {
 public:
  /// Number of episodes that are replayed together: enough for the simulator's chunks, and few
  /// enough that threads can share a scene's episodes.
  static constexpr std::size_t kMost = 64;

  /// The references must outlive this.
  EpisodeBatch(const GenerationContext& context, const SceneOfPack& scene,
               const PreparedScene& prepared);

  /// Draws `episodes`, whose numbers and seeds are set. Fails with the errors of replayEpisodes.
  /// Thread-safe for different episodes.
  [[nodiscard]] Result<void> fill(std::span<DrawnEpisode> episodes) const;

 private:
  /// An episode in progress.
  struct Pending;

  /// Makes drafts until one succeeds, or skips the episode.
  void draw(Pending& pending) const;
  /// Finds out which episodes start and stay still in the runtime.
  [[nodiscard]] Result<void> replay(std::span<Pending* const> open) const;

  const GenerationContext& context_;
  const SceneOfPack& scene_;
  const DraftHome home_;
  std::vector<const PackFile*> packs_;
  std::span<const ProvenPair> proven_;
};

}  // namespace galactic::bake
