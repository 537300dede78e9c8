#include "galactic/scene.h"

#include <cmath>
#include <string>

#include "column_grid/grid_layout.h"
#include "galactic/schema/pack_generated.h"

namespace galactic {

Result<Scene> Scene::from(const PackFile& pack) {
  const schema::Scene* stored =
      pack.kind() == PackKind::kScene ? pack.root().asset_as_Scene() : nullptr;
  if (stored == nullptr) {
    return fail(ErrorCode::kInvalidInput, pack.where(),
                "is a pack of kind " + packKindName(pack.kind()) +
                    ", expected a scene (SCEN); give the pack of a scene");
  }
  Scene scene;
  scene.name_ = {stored->name()->c_str(), stored->name()->size()};
  scene.grids_.reserve(stored->column_grids()->size());
  for (const schema::ColumnGrid* grid : *stored->column_grids()) {
    scene.grids_.emplace_back(detail::gridLayout(*grid, pack.bytes().data()));
  }
  return scene;
}

std::optional<std::size_t> Scene::gridIndex(float radius) const {
  // Radii that a user typed and radii that packs store may differ in the last digit.
  constexpr float kSameRadius = 1e-6F;
  for (std::size_t n = 0; n < grids_.size(); ++n) {
    if (std::fabs(grids_[n].radius() - radius) <= kSameRadius) return n;
  }
  return std::nullopt;
}

}  // namespace galactic
