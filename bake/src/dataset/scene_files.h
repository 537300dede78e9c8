#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "galactic/bake/mesh_import.h"
#include "galactic/error.h"

namespace galactic::bake {

/// The mesh of one scene in a folder of scans.
struct SceneFile {
  std::filesystem::path path;
  /// The file's name without its ending, or with as many folders before it as make it unique.
  std::string name;
  /// Which way is up in the file, where that is known of its kind; none: as the file says.
  std::optional<UpAxis> up;
  /// Its NAME.stage_config.json, which says so instead; empty where there is none.
  std::filesystem::path attributes;
};

/// The scenes in a folder of scans, as Matterport3D, HM3D and Gibson are published for Habitat:
/// SCENE.glb side by side, SCENE/SCENE.glb, or those in folders such as train/ and val/; for
/// folders of other scans, *.ply and *.obj count likewise. Ascending by path.
///
/// Passed over: what belongs to a scene but is not its surface (*.semantic.glb, *_semantic.ply,
/// *.navmesh and so on), SCENE.basis.glb beside SCENE.glb, SCENE.ply and SCENE.obj beside
/// SCENE.glb, hidden files and folders, and links to folders. Habitat takes each GLB without
/// attributes for Z up, against glTF, and for the three it is: these have up = kZ.
///
/// Fails with kIo where a folder cannot be read or a link with a scene's name leads to nothing, and
/// with kInvalidInput where there is no scene.
[[nodiscard]] Result<std::vector<SceneFile>> findSceneFiles(const std::filesystem::path& folder);

}  // namespace galactic::bake
