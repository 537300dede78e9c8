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

/// The result of a look at a scene.
struct SceneLook {
  /// Why there can be no episodes; empty if there can be some.
  std::string unusable;
  /// Only for usable scenes; without the number of episodes.
  GeneratedScene summary;
};

/// The progress of a generation that may be interrupted: looks at scenes, and batches of episodes.
/// Thread-safe.
class SceneJournal {
 public:
  /// Hash of everything that the results in a scene depend on, besides the journal's subject.
  using Key = detail::ContentHash;
  [[nodiscard]] static Key keyOf(std::string_view scene, const SceneDetails& details);

  /// `journal` is null if nothing is to be kept; otherwise it must outlive this. `objects` is the
  /// number of objects that can be placed.
  SceneJournal(Journal* journal, std::size_t objects);

  /// Whether some scene with this name was unusable.
  [[nodiscard]] bool hasUnusable(std::string_view scene) const;
  /// Null if the scene has not been looked at.
  [[nodiscard]] const SceneLook* lookAt(const Key& key) const;
  /// If these episodes, whose numbers and seeds are set, were drawn before, fills them in and
  /// returns true.
  [[nodiscard]] bool recall(const Key& key, std::span<DrawnEpisode> episodes) const;

  /// These fail with kIo.
  [[nodiscard]] Result<void> add(const Key& key, const SceneLook& look) const;
  [[nodiscard]] Result<void> add(const Key& key, std::span<const DrawnEpisode> episodes) const;

 private:
  using Name = std::pair<std::uint64_t, std::uint64_t>;
  void read(std::string_view record);

  Journal* journal_;
  std::size_t objects_;
  std::map<Name, SceneLook> looks_;
  /// The keys also contain the number of the first episode.
  std::map<std::pair<Name, std::size_t>, std::vector<DrawnEpisode>> batches_;
};

}  // namespace galactic::bake
