#include "pack_tool/support/open_scene.h"

#include <fmt/format.h>

#include "support/try.h"

namespace galactic::pack_tool {

Result<OpenScene> OpenScene::open(const std::filesystem::path& path, Trust trust) {
  ASSIGN_OR_RETURN(auto pack, PackFile::open(path, trust));
  ASSIGN_OR_RETURN(auto scene, sceneOf(pack));
  return OpenScene{std::move(pack), std::move(scene)};
}

Result<Scene> sceneOf(const PackFile& pack) {
  if (pack.kind() == PackKind::kScene) return Scene::from(pack);
  return fail(
      ErrorCode::kInvalidInput, pack.where(),
      fmt::format("is a pack of kind {} and holds no column grids; give the pack of a scene "
                  "(SCEN)",
                  packKindName(pack.kind())));
}

Result<std::vector<ColumnGrid>> gridsOf(const Scene& scene, const std::string& where,
                                        std::optional<float> radius) {
  if (!radius) return scene.grids();
  if (const auto index = scene.gridIndex(*radius)) return std::vector{scene.grids()[*index]};
  std::string radii;
  for (const ColumnGrid& grid : scene.grids()) {
    radii += fmt::format("{}{}", radii.empty() ? "" : ", ", grid.radius());
  }
  return fail(ErrorCode::kInvalidInput, where,
              fmt::format("has no grid of radius {} m; its radii are {}", *radius, radii));
}

}  // namespace galactic::pack_tool
