#include "pack_tool/open_scene.h"

#include <fmt/format.h>

#include <string>

namespace galactic::pack_tool {

Result<OpenScene> OpenScene::open(const std::filesystem::path& path, Trust trust) {
  auto pack = PackFile::open(path, trust);
  if (!pack) return tl::unexpected(pack.error());
  auto scene = Scene::from(*pack);
  if (!scene) return tl::unexpected(scene.error());
  return OpenScene{std::move(*pack), std::move(*scene)};
}

Result<std::vector<ColumnGrid>> OpenScene::grids(std::optional<float> radius) const {
  if (!radius) return scene.grids();
  if (const auto index = scene.gridIndex(*radius)) return std::vector{scene.grids()[*index]};
  std::string radii;
  for (const ColumnGrid& grid : scene.grids()) {
    radii += fmt::format("{}{}", radii.empty() ? "" : ", ", grid.radius());
  }
  return fail(ErrorCode::kInvalidInput, pack.where(),
              fmt::format("has no grid of radius {} m; its radii are {}", *radius, radii));
}

}  // namespace galactic::pack_tool
