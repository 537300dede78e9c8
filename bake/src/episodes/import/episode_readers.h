#pragma once
#include <filesystem>

#include "galactic/bake/episode_set_import.h"
#include "json/json_reader.h"

namespace galactic::bake {

/// The JSON document of a file of episodes, compressed with gzip or not.
[[nodiscard]] Result<Json> readEpisodeJson(const std::filesystem::path& path);

/// readEpisodeSet, of a document that is read already.
[[nodiscard]] Result<SourceEpisodes> readEpisodeSetJson(const std::filesystem::path& path,
                                                        const Json& json,
                                                        const EpisodeImportOptions& options);

/// readHabitatEpisodes, of a document that is read already.
[[nodiscard]] Result<SourceEpisodes> readHabitatJson(const std::filesystem::path& path,
                                                     const Json& json,
                                                     const EpisodeImportOptions& options);

}  // namespace galactic::bake
