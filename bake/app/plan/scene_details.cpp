#include "plan/scene_details.h"

#include <map>
#include <string>
#include <utility>

#include "bake_run.h"
#include "galactic/bake/mesh_import.h"
#include "galactic/bake/triangle_mesh.h"

namespace galactic::bake {
namespace {

Result<SourceAsset> readScene(const PlannedPack& pack, SceneDetails& details) {
  if (!pack.scene) return importMesh(pack.command.inputs.front(), pack.command.import);
  auto composed = pack.scene->dataset->compose(pack.scene->name, *pack.scene->meshes);
  if (!composed) return tl::unexpected(composed.error());
  details.receptacles = std::move(composed->receptacles);
  return std::move(composed->scene);
}

Result<SceneDetails> readDetails(const PlannedPack& pack) {
  SceneDetails details;
  const auto asset = readScene(pack, details);
  if (!asset) return tl::unexpected(asset.error());
  auto clean = placeAndClean(*asset);
  if (!clean) {
    return fail(clean.error().code, inFile(pack.command.inputs.front(), clean.error().where),
                clean.error().message);
  }
  details.mesh = std::move(clean->mesh);
  return details;
}

std::string sceneName(const PlannedPack& pack) {
  if (!pack.command.asset_name.empty()) return pack.command.asset_name;
  return pack.command.inputs.front().stem().string();
}

}  // namespace

SceneDetailSource sceneDetails(const std::vector<PlannedPack>& assets) {
  std::map<std::string, PlannedPack, std::less<>> scenes;
  for (const PlannedPack& pack : assets) {
    if (pack.command.kind == AssetKind::kScene) scenes.emplace(sceneName(pack), pack);
  }
  return [scenes = std::move(scenes)](std::string_view name) -> Result<SceneDetails> {
    const auto found = scenes.find(name);
    if (found == scenes.end()) return SceneDetails{};
    return readDetails(found->second);
  };
}

}  // namespace galactic::bake
