#pragma once
#include <filesystem>

#include "galactic/bake/episode_set_import.h"
#include "json/json_reader.h"

namespace galactic::bake {

/// Reads the JSON document of a file of episodes, whether compressed with gzip or not.
[[nodiscard]] Result<Json> readEpisodeJson(const std::filesystem::path& path);

/// readEpisodeSet for a document that has been read.
[[nodiscard]] Result<SourceEpisodes> readEpisodeSetJson(const std::filesystem::path& path,
                                                        const Json& json,
                                                        const EpisodeImportOptions& options);

/// readHabitatEpisodes for a document that has been read.
[[nodiscard]] Result<SourceEpisodes> readHabitatJson(const std::filesystem::path& path,
                                                     const Json& json,
                                                     const EpisodeImportOptions& options);

}  // namespace galactic::bake
