#include <map>
#include <string>
#include <utility>

#include "asset/asset_parts.h"
#include "build/pack_list.h"
#include "dataset/scene_dataset.h"
#include "galactic/bake/mesh_import.h"
#include "galactic/bake/triangle_mesh.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

Result<SourceAsset> readScene(const SceneJob& job, SceneDetails& details) {
  if (!job.instance) return importMesh(job.input, job.import);
  ASSIGN_OR_RETURN(auto composed,
                   job.instance->dataset->compose(job.instance->name, *job.instance->meshes));
  details.receptacles = std::move(composed.receptacles);
  return std::move(composed.scene);
}

Result<SceneDetails> readDetails(const SceneJob& job) {
  SceneDetails details;
  ASSIGN_OR_RETURN(const auto asset, readScene(job, details));
  auto clean = placeAndClean(asset);
  if (!clean) {
    return fail(clean.error().code, inFile(job.input, clean.error().where), clean.error().message);
  }
  details.mesh = std::move(clean->mesh);
  return details;
}

std::string sceneName(const SceneJob& job) {
  return job.name.empty() ? job.input.stem().string() : job.name;
}

}  // namespace

SceneDetailSource sceneDetails(const std::vector<PackJob>& assets) {
  std::map<std::string, SceneJob, std::less<>> scenes;
  for (const PackJob& pack : assets) {
    if (const auto* job = std::get_if<SceneJob>(&pack.job)) scenes.emplace(sceneName(*job), *job);
  }
  return [scenes = std::move(scenes)](std::string_view name) -> Result<SceneDetails> {
    const auto found = scenes.find(name);
    if (found == scenes.end()) return SceneDetails{};
    return readDetails(found->second);
  };
}

}  // namespace galactic::bake
