#pragma once
#include <atomic>
#include <cstddef>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "episodes/drawn_episode.h"
#include "episodes/home/prepared_scene.h"
#include "episodes/scene_journal.h"
#include "galactic/bake/episode_generator.h"
#include "galactic/error.h"

namespace galactic::bake {

/// One scene, its part of the episodes and what became of them.
struct SceneTask {
  const SceneOfPack* scene = nullptr;
  std::vector<DrawnEpisode> episodes{};
  GeneratedScene summary{};
  /// Why there can be no episodes; empty when there can be.
  std::string unusable{};
  /// What came of reading and preparing the scene, and of drawing its episodes.
  Result<void> prepared{};
  Result<void> drawn{};
};

/// Reads what is known of a scene; nothing where nobody knows.
[[nodiscard]] Result<SceneDetails> detailsOf(const EpisodeInputs& inputs, const SceneOfPack& scene);

/// Draws episodes in the scenes that they were dealt to, or finds that they were drawn before.
class GenerationRound {
 public:
  /// The references outlive it.
  GenerationRound(const EpisodeInputs& inputs, const GenerationContext& context,
                  const SceneJournal& journal, const EpisodeProgress& progress)
      : inputs_(inputs), context_(context), journal_(journal), progress_(progress) {}

  /// Once a scene turns out to be unusable, the episodes will be dealt anew: then the others are
  /// looked at only.
  void run(std::vector<SceneTask>& tasks);

  /// Whether somebody stopped it, with some of the tasks not done.
  [[nodiscard]] bool isStopped() const { return is_stopped_; }
  /// Whether what it did could not be kept, with an error in one of the tasks.
  [[nodiscard]] bool hasFailed() const { return has_failed_; }

 private:
  class SceneWork;

  [[nodiscard]] unsigned scenesAtOnce(std::span<const SceneTask> tasks) const;
  [[nodiscard]] Result<void> draw(SceneTask& task, SceneWork& work, unsigned jobs);
  void runIn(SceneTask& task, unsigned jobs);
  /// Whether to begin nothing more, as somebody asks for it or what is done cannot be kept.
  [[nodiscard]] bool stops();
  /// Remembers that it failed.
  [[nodiscard]] Result<void> kept(Result<void> added);
  /// Tells the user, one call at a time.
  void count(std::size_t episodes);

  const EpisodeInputs& inputs_;
  const GenerationContext& context_;
  const SceneJournal& journal_;
  const EpisodeProgress& progress_;
  std::mutex mutex_;
  std::size_t done_ = 0;
  std::atomic<bool> only_look_{false};
  std::atomic<bool> is_stopped_{false};
  std::atomic<bool> has_failed_{false};
};

}  // namespace galactic::bake
