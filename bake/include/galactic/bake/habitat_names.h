#pragma once
#include <string>
#include <string_view>

namespace galactic::bake {

/// How the names of the files of Habitat's datasets end: the configuration of a dataset, the
/// attributes of its stages, objects and articulated objects, and its scenes.
inline constexpr std::string_view kDatasetSuffix = ".scene_dataset_config.json";
inline constexpr std::string_view kStageSuffix = ".stage_config.json";
inline constexpr std::string_view kObjectSuffix = ".object_config.json";
inline constexpr std::string_view kArticulatedSuffix = ".ao_config.json";
inline constexpr std::string_view kSceneSuffix = ".scene_instance.json";
/// How a scan's mesh ends whose textures are Basis Universal's: NAME.glb is the same scan.
inline constexpr std::string_view kBasisSuffix = ".basis.glb";

/// The name of what a file or handle of Habitat's means, a template or a scene:
/// "v3_sc1_staging_05" of "configs/scenes/v3_sc1_staging_05.scene_instance.json", "mesh" of
/// "00001/mesh.basis.glb". As names may have dots, only endings of Habitat's configurations and of
/// usual meshes and robots are taken off, in upper or lower case; without any, `extension`, the
/// ending of a file of another format.
[[nodiscard]] std::string habitatName(std::string_view path, std::string_view extension = {});

}  // namespace galactic::bake
