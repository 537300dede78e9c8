#pragma once
#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "episodes/drawn_episode.h"
#include "galactic/bake/episode_generator.h"
#include "galactic/error.h"
#include "support/content_hash.h"
#include "support/files/journal.h"

namespace galactic::bake {

/// What a look at a scene told.
struct SceneLook {
  /// Why there can be no episodes; empty where there can be.
  std::string unusable;
  /// Of a scene that is not unusable; without the number of episodes.
  GeneratedScene summary;
};

/// What a generation that was interrupted has done: looks at scenes, and batches of episodes.
/// Thread-safe.
class SceneJournal {
 public:
  /// What decides what is found in a scene, besides the journal's subject.
  using Key = detail::ContentHash;
  [[nodiscard]] static Key keyOf(std::string_view scene, const SceneDetails& details);

  /// `journal`: null where nothing is kept; else it outlives this. `objects`: how many there are to
  /// place.
  SceneJournal(Journal* journal, std::size_t objects);

  /// Whether some scene of that name was unusable.
  [[nodiscard]] bool hasUnusable(std::string_view scene) const;
  /// Null where nobody has looked.
  [[nodiscard]] const SceneLook* lookAt(const Key& key) const;
  /// Whether these episodes, whose numbers and seeds are given, were drawn before; they are as they
  /// were then.
  [[nodiscard]] bool recall(const Key& key, std::span<DrawnEpisode> episodes) const;

  /// Fail with kIo.
  [[nodiscard]] Result<void> add(const Key& key, const SceneLook& look) const;
  [[nodiscard]] Result<void> add(const Key& key, std::span<const DrawnEpisode> episodes) const;

 private:
  using Name = std::pair<std::uint64_t, std::uint64_t>;
  void read(std::string_view record);

  Journal* journal_;
  std::size_t objects_;
  std::map<Name, SceneLook> looks_;
  /// By the number of their first, too.
  std::map<std::pair<Name, std::size_t>, std::vector<DrawnEpisode>> batches_;
};

}  // namespace galactic::bake
