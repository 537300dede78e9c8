#include "galactic/world_models.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "galactic/object_set.h"
#include "galactic/render_library.h"
#include "galactic/scene.h"
#include "support/call_check.h"
#include "support/try.h"

namespace galactic {
namespace {

using ModelOfName = std::map<std::string_view, std::optional<std::uint32_t>, std::less<>>;

Result<SharedTextures> texturesOf(const World& world) {
  SharedTextures textures;
  for (const PackFile& pack : world.packs()) {
    if (pack.kind() != PackKind::kTexture) continue;
    RETURN_IF_ERROR(textures.add(pack));
  }
  return textures;
}

Result<RenderMeshes> requiredMeshes(const PackFile& pack, const SharedTextures& textures) {
  ASSIGN_OR_RETURN(std::optional<RenderMeshes> meshes, renderMeshesOf(pack, textures));
  if (!meshes.has_value()) {
    return fail(ErrorCode::kInvalidInput, pack.where(),
                "was baked without render meshes, which drawing needs; bake it again with them");
  }
  if (!meshes->missing_textures.empty()) {
    const MissingTexture& missing = meshes->missing_textures.front();
    return fail(
        ErrorCode::kInvalidInput, pack.where(),
        fmt::format("shares the texture \"{}\" ({:016x}{:016x}), which is in no pack of the "
                    "world; add its texture pack",
                    missing.name, missing.hash_high, missing.hash_low));
  }
  return std::move(*meshes);
}

/// Adds a pack's models. `name_of(part)` returns the name of what the model shows.
template <class NameOf>
void addNamed(RenderLibrary& library, RenderMeshes meshes, const NameOf& name_of,
              ModelOfName& models) {
  std::vector<std::pair<std::string_view, std::uint32_t>> shown;
  for (std::uint32_t n = 0; n < meshes.models.size(); ++n) {
    if (meshes.models[n].cluster_count != 0) shown.emplace_back(name_of(meshes.models[n].part), n);
  }
  const std::uint32_t first = library.add(std::move(meshes));
  for (const auto& [name, model] : shown) models[name] = first + model;
}

std::optional<std::uint32_t> find(const ModelOfName& models, std::string_view name) {
  const auto found = models.find(name);
  return found == models.end() ? std::nullopt : found->second;
}

}  // namespace

Result<WorldModels> WorldModels::from(const World& world) {
  auto content = std::make_shared<Content>();
  content->world_hash = world.hash();
  content->library.keep(std::make_shared<const World>(world));
  ModelOfName scenes;
  ModelOfName objects;
  ASSIGN_OR_RETURN(const SharedTextures textures, texturesOf(world));
  for (const PackFile& pack : world.packs()) {
    if (pack.kind() == PackKind::kEpisodes || pack.kind() == PackKind::kTexture) continue;
    ASSIGN_OR_RETURN(RenderMeshes meshes, requiredMeshes(pack, textures));
    if (pack.kind() == PackKind::kScene) {
      const std::string_view name = Scene::from(pack)->name();
      addNamed(
          content->library, std::move(meshes), [&](std::uint32_t) { return name; }, scenes);
    } else if (pack.kind() == PackKind::kObjects) {
      const Result<ObjectSet> set = ObjectSet::from(pack);
      const auto name_of = [&](std::uint32_t part) { return set->objects()[part].name; };
      addNamed(content->library, std::move(meshes), name_of, objects);
    } else {
      const std::vector<RenderModel> robot_models = meshes.models;
      const std::uint32_t first = content->library.add(std::move(meshes));
      for (std::uint32_t n = 0; n < robot_models.size(); ++n) {
        if (robot_models[n].cluster_count == 0) continue;
        content->links.push_back({robot_models[n].part, first + n});
      }
    }
  }
  content->scenes.reserve(world.scenes().size());
  for (const Scene& scene : world.scenes()) content->scenes.push_back(find(scenes, scene.name()));
  content->objects.reserve(world.episodes().objectNames().size());
  for (const std::string_view name : world.episodes().objectNames()) {
    content->objects.push_back(find(objects, name));
  }
  return WorldModels(std::move(content));
}

std::optional<std::uint32_t> WorldModels::sceneModel(std::uint32_t scene) const {
  detail::checkIndex("WorldModels::sceneModel", "scene", scene, content_->scenes.size());
  return content_->scenes[scene];
}

std::optional<std::uint32_t> WorldModels::objectModel(std::uint32_t object) const {
  detail::checkIndex("WorldModels::objectModel", "object", object, content_->objects.size());
  return content_->objects[object];
}

}  // namespace galactic
