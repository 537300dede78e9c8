#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "galactic/bake/source_asset.h"
#include "galactic/pose.h"

namespace galactic::bake {

/// A colored triangle mesh for pictures, exports and checks.
struct Surface {
  std::vector<Vec3> positions;
  std::vector<Triangle> triangles;
  /// RGBA, sRGB, 8 bits each, R lowest: one per position, or none for a neutral gray.
  std::vector<std::uint32_t> colors;

  [[nodiscard]] bool empty() const { return triangles.empty(); }
};

/// The color of a linear RGBA (0 to 1) as a Surface stores it.
[[nodiscard]] std::uint32_t surfaceColor(const std::array<float, 4>& linear);

/// Every instance of `asset`, placed by `frame_from_asset`, as one surface: colored by its
/// materials and vertex colors, or by `color` (linear RGBA) where given. Textures are not read.
[[nodiscard]] Surface surfaceOf(const SourceAsset& asset, const Affine& frame_from_asset,
                                const std::array<float, 4>* color = nullptr);

/// Appends `part` to `surface`; one of them may be without colors.
void append(Surface& surface, const Surface& part);

}  // namespace galactic::bake
