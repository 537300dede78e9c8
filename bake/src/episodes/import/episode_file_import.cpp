#include <array>
#include <string_view>

#include "episodes/import/episode_readers.h"

namespace galactic::bake {
namespace {

/// The largest published set of Habitat, with 50,000 episodes, is half this size.
constexpr std::size_t kMaxBytes = std::size_t{1} << 30U;

}  // namespace

Result<Json> readEpisodeJson(const std::filesystem::path& path) {
  return readJsonFile(
      path, {.what = "an episode set", .suffix = kEpisodeSetSuffix, .max_bytes = kMaxBytes});
}

std::string episodeSetName(const std::filesystem::path& path) {
  constexpr std::array<std::string_view, 3> kSuffixes{kEpisodeSetSuffix, ".episode_set.json.gz",
                                                      ".json.gz"};
  const std::string file = path.filename().string();
  for (const std::string_view suffix : kSuffixes) {
    if (file.size() > suffix.size() && file.ends_with(suffix)) {
      return file.substr(0, file.size() - suffix.size());
    }
  }
  return path.stem().string();
}

Result<SourceEpisodes> readEpisodeFile(const std::filesystem::path& path,
                                       const EpisodeImportOptions& options) {
  const auto json = readEpisodeJson(path);
  if (!json) return tl::unexpected(json.error());
  const bool habitat =
      json->is_object() && json->contains("episodes") && !json->contains("episodeSet");
  return habitat ? readHabitatJson(path, *json, options) : readEpisodeSetJson(path, *json, options);
}

}  // namespace galactic::bake
