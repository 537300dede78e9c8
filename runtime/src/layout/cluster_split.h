#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "layout/render_mesh_builder.h"

namespace galactic::render {

/// A cluster before its coordinates are rounded.
struct ClusterDraft {
  /// Indices into the vertices of the surface.
  std::vector<std::uint32_t> vertices;
  /// Corners: indices into `vertices`.
  std::vector<std::array<std::uint8_t, 3>> triangles;
};

/// Splits the triangles of a surface, whose indices must be in range, into drafts of at most
/// kMostInCluster vertices and triangles: follows a Morton curve through the triangles' centers,
/// and begins a new draft when one is full.
[[nodiscard]] std::vector<ClusterDraft> splitSurface(const RenderSurface& surface);

}  // namespace galactic::render
