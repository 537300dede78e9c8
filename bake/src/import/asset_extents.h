#pragma once
#include <array>

#include "galactic/bake/source_asset.h"

namespace galactic::bake {

/// Extents in meters, along the axes of the world, of the box around all placed triangles. Expects
/// indices in range and at least one triangle.
[[nodiscard]] std::array<double, 3> extentsOf(const SourceAsset& asset);

}  // namespace galactic::bake
