#pragma once
#include <filesystem>

#include "galactic/bake/assets.h"

namespace galactic::bake {

// A scene before it is baked: the mesh of a file, or a composed instance of a dataset.

/// A scene that has been read and is ready to be baked.
struct ReadScene {
  /// For messages.
  std::filesystem::path input;
  /// File names, such as those of textures, are relative to this folder.
  std::filesystem::path folder;
  SourceAsset asset;
};

/// Reads the meshes of a scene and notes in `log` which other files were looked for. The asset's
/// warnings include what an instance lacks. Fails with the errors of importMesh and
/// SceneDataset::compose, and with kInvalidInput if the height of a mesh suggests that its unit is
/// not the meter.
[[nodiscard]] Result<ReadScene> readScene(const SceneJob& job, ReadLog& log,
                                          BakeLibraries& libraries);

/// What episodes in a scene need besides its pack: its triangles, and where its dataset allows
/// things to be put. Fails like readScene, except that it accepts any height, and with the errors
/// of placeAndClean, whose `where` names the input.
[[nodiscard]] Result<SceneDetails> readSceneDetails(const SceneJob& job, BakeLibraries& libraries);

}  // namespace galactic::bake
