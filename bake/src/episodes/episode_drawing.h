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

/// A scene and the episodes that are dealt to it: their numbers and seeds.
struct DealtScene {
  const SceneOfPack* scene = nullptr;
  std::vector<DrawnEpisode> episodes{};
};

/// A scene and the episodes that were drawn in it.
struct DrawnScene {
  GeneratedScene summary{};
  std::vector<DrawnEpisode> episodes{};
};

/// Reads what is known of a scene; nothing where nobody knows.
[[nodiscard]] Result<SceneDetails> detailsOf(const EpisodeInputs& inputs, const SceneOfPack& scene);

/// Draws episodes in the scenes that they were dealt to, or finds that they were drawn before.
class EpisodeDrawing {
 public:
  /// What was drawn, in the order of the deal; or the scenes in which there can be no episodes:
  /// then they are to be dealt anew, and what was drawn beside them is no matter.
  using Outcome = std::variant<std::vector<DrawnScene>, std::vector<UnusableScene>>;

  /// The references outlive it.
  EpisodeDrawing(const EpisodeInputs& inputs, const GenerationContext& context,
                 const SceneJournal& journal, const EpisodeProgress& progress)
      : inputs_(inputs), context_(context), journal_(journal), progress_(progress) {}

  /// Called once. Fails with the errors of reading and preparing a scene, of drawing in it, and of
  /// the journal, and with kInterrupted.
  [[nodiscard]] Result<Outcome> run(std::vector<DealtScene> deal);

 private:
  class SceneWork;

  /// What became of one scene: nothing where it was only looked at, or not begun; or what was
  /// drawn, or why it could not be. An error where the scene cannot be looked at.
  using InScene = std::variant<std::monostate, UnusableScene, Result<DrawnScene>>;
  using SceneResult = Result<InScene>;

  /// What is still done. It only ever goes on to a later one.
  enum class State : std::uint8_t {
    kDrawing,  ///< Everything.
    kLooking,  ///< Some scene is unusable: the others are looked at only.
    kStopped,  ///< Nothing: somebody asked for it.
    kFailed,   ///< Nothing: what is done cannot be kept.
  };

  [[nodiscard]] unsigned scenesAtOnce(std::span<const DealtScene> deal) const;
  /// Looks at the scene, draws its episodes with `threads` threads, and forgets the scene.
  [[nodiscard]] SceneResult runIn(DealtScene dealt, unsigned threads);
  /// Draws those of the scene's episodes that were not drawn before.
  [[nodiscard]] Result<void> fill(std::span<DrawnEpisode> episodes, SceneWork& work,
                                  unsigned threads);
  [[nodiscard]] Result<Outcome> outcomeOf(std::vector<SceneResult> results) const;

  void goOnTo(State state);
  /// The state, after asking whether to stop.
  [[nodiscard]] State stateNow();
  /// The same error; remembers where it says that something could not be kept.
  [[nodiscard]] Error noted(Error error);
  /// Tells the user, one call at a time.
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
