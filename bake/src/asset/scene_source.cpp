#include "asset/scene_source.h"

#include <utility>

#include "asset/asset_parts.h"
#include "dataset/dataset_library.h"
#include "galactic/bake/mesh_import.h"
#include "galactic/bake/triangle_mesh.h"
#include "import/checks/asset_check.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

namespace fs = std::filesystem;

Result<OpenDataset*> datasetOf(const SceneJob& job, BakeLibraries& libraries) {
  return libraries.datasets().open(job.input, {job.import.allow_outside});
}

/// The folder that the scene's file names are relative to.
Result<fs::path> folderOf(const SceneJob& job, BakeLibraries& libraries) {
  if (!job.instance) return job.input.parent_path();
  ASSIGN_OR_RETURN(const OpenDataset* const dataset, datasetOf(job, libraries));
  return dataset->scenes.folder();
}

/// Composes the scene of a dataset. A single file becomes a scene that consists only of its mesh.
Result<ComposedScene> readMeshes(const SceneJob& job, BakeLibraries& libraries) {
  if (job.instance) {
    ASSIGN_OR_RETURN(OpenDataset* const dataset, datasetOf(job, libraries));
    return dataset->scenes.compose(job.instance->name, dataset->meshes);
  }
  ASSIGN_OR_RETURN(auto asset, importMesh(job.input, job.import));
  ComposedScene read;
  read.scene = std::move(asset);
  return read;
}

}  // namespace

std::string nameOf(const SceneJob& job) {
  if (!job.name.empty()) return job.name;
  return job.instance ? job.instance->name : job.input.stem().string();
}

Result<ReadScene> readScene(const SceneJob& job, ReadLog& log, BakeLibraries& libraries) {
  ASSIGN_OR_RETURN(auto read, readMeshes(job, libraries));
  SourceAsset& asset = read.scene;
  if (!job.instance && !job.import.scale) {
    RETURN_IF_ERROR(checkHeight(asset, job.input.string()));
  }
  if (!job.instance && !job.import.up && !job.import.transform) warnAboutUp(asset);
  ASSIGN_OR_RETURN(const fs::path folder, folderOf(job, libraries));
  log.note(folder, asset.read);
  asset.warnings.insert(asset.warnings.end(), read.missing.begin(), read.missing.end());
  return ReadScene{.input = job.instance ? folder / job.instance->name : job.input,
                   .folder = folder,
                   .asset = std::move(asset)};
}

Result<SceneDetails> readSceneDetails(const SceneJob& job, BakeLibraries& libraries) {
  ASSIGN_OR_RETURN(auto read, readMeshes(job, libraries));
  auto clean = placeAndClean(read.scene);
  if (!clean) {
    const Error& error = clean.error();
    return fail(error.code, inFile(job.input, error.where), error.message);
  }
  SceneDetails details;
  details.mesh = std::move(clean->mesh);
  details.receptacles = std::move(read.receptacles);
  return details;
}

Result<SourceAsset> readSceneFile(const SceneJob& job, BakeLibraries& libraries) {
  ReadLog log;
  ASSIGN_OR_RETURN(auto scene, readScene(job, log, libraries));
  return std::move(scene.asset);
}

}  // namespace galactic::bake
