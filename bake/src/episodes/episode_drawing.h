#pragma once
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <span>
#include <variant>
#include <vector>

#include "episodes/drawn_episode.h"
#include "episodes/home/prepared_scene.h"
#include "episodes/scene_journal.h"
#include "galactic/bake/episode_generator.h"
#include "galactic/error.h"

namespace galactic::bake {

/// A scene and the episodes assigned to it, with their numbers and seeds.
struct DealtScene {
  const SceneOfPack* scene = nullptr;
  std::vector<DrawnEpisode> episodes{};
};

/// A scene and the episodes that were drawn in it.
struct DrawnScene {
  GeneratedScene summary{};
  std::vector<DrawnEpisode> episodes{};
};

/// Reads what is known about a scene; empty if nothing is.
[[nodiscard]] Result<SceneDetails> detailsOf(const EpisodeInputs& inputs, const SceneOfPack& scene);

/// Draws episodes in the scenes that they were dealt to, or recalls those that the journal holds.
class EpisodeDrawing {
 public:
  /// The drawn episodes, in the order of the deal; or the scenes in which there can be no episodes,
  /// in which case all episodes must be dealt anew, and any that were drawn are dropped.
  using Outcome = std::variant<std::vector<DrawnScene>, std::vector<UnusableScene>>;

  /// The references must outlive this.
  EpisodeDrawing(const EpisodeInputs& inputs, const GenerationContext& context,
                 const SceneJournal& journal, const EpisodeProgress& progress)
      : inputs_(inputs), context_(context), journal_(journal), progress_(progress) {}

  /// May be called once. Fails with the errors of reading and preparing a scene, of drawing in it
  /// and of the journal, and with kInterrupted.
  [[nodiscard]] Result<Outcome> run(std::vector<DealtScene> deal);

 private:
  class SceneWork;

  /// The result for one scene: nothing if it was only looked at, or not begun; otherwise what was
  /// drawn, or why nothing could be. It is an error if the scene cannot be looked at.
  using InScene = std::variant<std::monostate, UnusableScene, Result<DrawnScene>>;
  using SceneResult = Result<InScene>;

  /// How much is still to be done. The state only ever moves to a later one.
  enum class State : std::uint8_t {
    kDrawing,  ///< Everything.
    kLooking,  ///< Some scene is unusable: only look at the others.
    kStopped,  ///< Nothing, because somebody asked to stop.
    kFailed,   ///< Nothing, because results cannot be saved.
  };

  [[nodiscard]] unsigned scenesAtOnce(std::span<const DealtScene> deal) const;
  /// Looks at the scene, draws its episodes with `threads` threads, and releases the scene.
  [[nodiscard]] SceneResult runIn(DealtScene dealt, unsigned threads);
  /// Draws those of the scene's episodes that the journal does not hold.
  [[nodiscard]] Result<void> fill(std::span<DrawnEpisode> episodes, SceneWork& work,
                                  unsigned threads);
  [[nodiscard]] Result<Outcome> outcomeOf(std::vector<SceneResult> results) const;

  void goOnTo(State state);
  /// The state, after asking whether to stop.
  [[nodiscard]] State stateNow();
  /// Returns the error unchanged; moves to kFailed if it says that something could not be saved.
  [[nodiscard]] Error noted(Error error);
  /// Reports progress to the user, one call at a time.
  void count(std::size_t episodes);

  const EpisodeInputs& inputs_;
  const GenerationContext& context_;
  const SceneJournal& journal_;
  const EpisodeProgress& progress_;
  std::atomic<State> state_{State::kDrawing};
  std::mutex mutex_;
  std::size_t all_ = 0;
  std::size_t done_ = 0;
};

}  // namespace galactic::bake
