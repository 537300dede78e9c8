#include "asset/scene_source.h"

#include <utility>

#include "asset/asset_parts.h"
#include "dataset/scene_dataset.h"
#include "galactic/bake/mesh_import.h"
#include "galactic/bake/triangle_mesh.h"
#include "import/checks/asset_check.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

namespace fs = std::filesystem;

/// A file's mesh as a scene composed of it alone.
Result<ComposedScene> readMeshes(const SceneJob& job) {
  if (job.instance)
    return job.instance->dataset->compose(job.instance->name, *job.instance->meshes);
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

Result<ReadScene> readScene(const SceneJob& job, ReadLog& log) {
  ASSIGN_OR_RETURN(auto read, readMeshes(job));
  SourceAsset& asset = read.scene;
  if (!job.instance && !job.import.scale) {
    RETURN_IF_ERROR(checkHeight(asset, job.input.string()));
  }
  const fs::path folder = job.instance ? job.instance->dataset->folder() : job.input.parent_path();
  log.note(folder, asset.read);
  asset.warnings.insert(asset.warnings.end(), read.missing.begin(), read.missing.end());
  return ReadScene{.input = job.instance ? folder / job.instance->name : job.input,
                   .folder = folder,
                   .asset = std::move(asset)};
}

Result<SceneDetails> readSceneDetails(const SceneJob& job) {
  ASSIGN_OR_RETURN(auto read, readMeshes(job));
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

Result<SourceAsset> readSceneFile(const SceneJob& job) {
  ReadLog log;
  ASSIGN_OR_RETURN(auto scene, readScene(job, log));
  return std::move(scene.asset);
}

}  // namespace galactic::bake
