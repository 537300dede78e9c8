#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "layout/render_mesh_builder.h"

namespace galactic::render {

/// A cluster before its numbers are rounded.
struct ClusterDraft {
  /// Indices into the vertices of the surface.
  std::vector<std::uint32_t> vertices;
  /// Corners: indices into `vertices`.
  std::vector<std::array<std::uint8_t, 3>> triangles;
};

/// The triangles of a surface, whose indices are within range, in drafts of at most kMostInCluster
/// vertices and triangles: taken along a Morton curve through their centers, and a new draft begun
/// where the one before is full.
[[nodiscard]] std::vector<ClusterDraft> splitSurface(const RenderSurface& surface);

}  // namespace galactic::render
