#include "dataset/dataset_library.h"

#include "support/try.h"

namespace galactic::bake {

Result<OpenDataset*> DatasetLibrary::open(const std::filesystem::path& config,
                                          const DatasetReadOptions& options) {
  const std::lock_guard lock(mutex_);
  const std::pair key(config, options.allow_outside);
  if (const auto known = open_.find(key); known != open_.end()) return &known->second;
  ASSIGN_OR_RETURN(auto scenes, SceneDataset::read(config, options));
  MeshImportOptions meshes = datasetMeshOptions();
  meshes.allow_outside = options.allow_outside;
  return &open_.try_emplace(key, std::move(scenes), meshes).first->second;
}

}  // namespace galactic::bake
