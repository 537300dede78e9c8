#pragma once
#include <array>

#include "galactic/bake/source_asset.h"

namespace galactic::bake {

/// Of the box around all placed triangles, along the axes of the world: meters. Indices are in
/// range, and there is a triangle.
[[nodiscard]] std::array<double, 3> extentsOf(const SourceAsset& asset);

}  // namespace galactic::bake
