#pragma once
#include <filesystem>
#include <map>
#include <mutex>
#include <utility>

#include "dataset/mesh_library.h"
#include "dataset/scene_dataset.h"
#include "galactic/error.h"

namespace galactic::bake {

/// A dataset that was read, and the meshes that its scenes share.
struct OpenDataset {
  OpenDataset(SceneDataset read, const MeshImportOptions& options)
      : scenes(std::move(read)), meshes(options) {}

  SceneDataset scenes;
  MeshLibrary meshes;
};

/// Datasets of which many scenes are baked, each read once. Thread-safe.
class DatasetLibrary {
 public:
  /// The dataset of a configuration; it lives as long as the library. Fails with the errors of
  /// SceneDataset::read, each time.
  [[nodiscard]] Result<OpenDataset*> open(const std::filesystem::path& config,
                                          const DatasetReadOptions& options);

 private:
  std::mutex mutex_;
  /// By configuration, and whether it may read anywhere.
  std::map<std::pair<std::filesystem::path, bool>, OpenDataset> open_;
};

}  // namespace galactic::bake
