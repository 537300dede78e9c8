#include "check/asset_checks.h"
#include "check/common_check.h"
#include "check/offence.h"
#include "check/render_check.h"
#include "column_grid/column_grid_check.h"

namespace galactic::detail {
namespace {

constexpr std::size_t kMaxGrids = 8;

}  // namespace

Result<void> checkScene(const schema::Scene& scene, std::span<const std::byte> file,
                        const std::string& where) {
  Offence offence(where + ": scene");
  offence.require(!isEmpty(scene.name()), "name", "is empty, expected the scene's name");
  offence.require(checkBounds(scene.bounds(), offence.where()));
  offence.require(checkImport(*scene.import_statistics(), offence.where()));

  const auto& grids = *scene.column_grids();
  offence.require(grids.size() >= 1 && grids.size() <= kMaxGrids, "column_grids",
                  "has {} grids, expected 1 to {}", grids.size(), kMaxGrids);
  for (flatbuffers::uoffset_t n = 0; n < grids.size() && !offence.found(); ++n) {
    const std::string field = fmt::format("column_grids[{}]", n);
    offence.require(checkColumnGrid(*grids.Get(n), file, offence.where() + "." + field));
    if (n == 0) continue;
    const float previous = grids.Get(n - 1)->radius();
    offence.require(grids.Get(n)->radius() > previous, field + ".radius",
                    "is {} m after {} m, expected ascending radii", grids.Get(n)->radius(),
                    previous);
  }
  if (scene.render_meshes() != nullptr && !offence.found()) {
    offence.require(checkRenderMeshes(*scene.render_meshes(), 1, offence.where()));
  }
  return offence.result();
}

}  // namespace galactic::detail
