#pragma once
#include <string>
#include <string_view>

#include "galactic/bake/episode_set_import.h"
#include "support/episode_set_text.h"
#include "support/scratch_folder.h"

namespace galactic::test {

inline bake::EpisodeImportOptions twoJoints() {
  bake::EpisodeImportOptions options;
  options.start_joints = {"pan", "lift"};
  return options;
}

inline Result<bake::SourceEpisodes> importText(
    std::string_view text, const bake::EpisodeImportOptions& options = twoJoints()) {
  const ScratchFolder folder;
  return bake::readEpisodeSet(folder.write("small.episode_set.json", text), options);
}

/// `text` with the first `from` replaced.
inline std::string replaced(std::string text, std::string_view from, std::string_view to) {
  return text.replace(text.find(from), from.size(), to);
}

}  // namespace galactic::test
