#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "episodes/drawn_episode.h"
#include "episodes/home/prepared_scene.h"
#include "galactic/error.h"

namespace galactic::bake {

/// Draws a batch of episodes in a scene and replays them until all stand.
class EpisodeBatch {
 public:
  /// Episodes that are replayed together: enough for the simulator's chunks, few enough for threads
  /// to share a scene's episodes.
  static constexpr std::size_t kMost = 64;

  /// The references outlive it.
  EpisodeBatch(const GenerationContext& context, const SceneOfPack& scene,
               const PreparedScene& prepared);

  /// `episodes`: their numbers and seeds are given. Fails with the errors of replayEpisodes.
  /// Thread-safe for different episodes.
  [[nodiscard]] Result<void> fill(std::span<DrawnEpisode> episodes) const;

 private:
  /// An episode in the making.
  struct Pending;

  /// Drafts until a draft succeeds, or the episode is skipped.
  void draw(Pending& pending) const;
  /// Sees which of them stand.
  [[nodiscard]] Result<void> replay(std::span<Pending* const> open) const;

  const GenerationContext& context_;
  const SceneOfPack& scene_;
  const DraftHome home_;
  std::vector<const PackFile*> packs_;
  std::span<const ProvenPair> proven_;
};

}  // namespace galactic::bake
