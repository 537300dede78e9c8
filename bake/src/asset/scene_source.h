#pragma once
#include <filesystem>

#include "galactic/bake/assets.h"

namespace galactic::bake {

// A scene before it is baked: the mesh of a file, or an instance of a dataset put together.

/// A scene that was read, ready to be baked.
struct ReadScene {
  /// For messages.
  std::filesystem::path input;
  /// Names of files, textures among them, are relative to it.
  std::filesystem::path folder;
  SourceAsset asset;
};

/// Reads the meshes of a scene and notes in `log` what was looked for besides; what an instance
/// lacks is among the asset's warnings. Fails with the errors of importMesh and
/// SceneDataset::compose, and with kInvalidInput on a mesh whose height tells of another unit.
[[nodiscard]] Result<ReadScene> readScene(const SceneJob& job, ReadLog& log,
                                          BakeLibraries& libraries);

/// What episodes in a scene need to know beside its pack: its triangles, and where its dataset says
/// that things may be put. Fails as readScene does, but on no height, and with the errors of
/// placeAndClean; `where` names the input.
[[nodiscard]] Result<SceneDetails> readSceneDetails(const SceneJob& job, BakeLibraries& libraries);

}  // namespace galactic::bake
