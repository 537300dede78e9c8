#pragma once
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

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

/// The name of what a file of Habitat describes: "v3_sc1_staging_05" of
/// "configs/scenes/v3_sc1_staging_05.scene_instance.json", "mesh" of "00001/mesh.basis.glb". Only
/// endings that Habitat's configurations and meshes have are taken off: names may have dots.
[[nodiscard]] std::string habitatName(std::string_view path);

/// Which of several objects is meant by an instance handle: "mug_:0002" is the third of "mug".
struct HabitatInstance {
  std::string object;
  std::size_t number = 0;
};

/// Nothing where `handle` is none.
[[nodiscard]] std::optional<HabitatInstance> habitatInstance(std::string_view handle);

}  // namespace galactic::bake
