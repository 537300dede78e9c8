#include <map>
#include <string>
#include <utility>

#include "asset/scene_source.h"
#include "build/pack_list.h"

namespace galactic::bake {

SceneDetailSource sceneDetails(const std::vector<PackJob>& assets) {
  std::map<std::string, SceneJob, std::less<>> scenes;
  for (const PackJob& pack : assets) {
    if (const auto* job = std::get_if<SceneJob>(&pack.job)) scenes.emplace(nameOf(*job), *job);
  }
  return [scenes = std::move(scenes)](std::string_view name) -> Result<SceneDetails> {
    const auto found = scenes.find(name);
    if (found == scenes.end()) return SceneDetails{};
    return readSceneDetails(found->second);
  };
}

}  // namespace galactic::bake
