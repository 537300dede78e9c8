#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "galactic/render_meshes.h"
#include "layout/render_layout.h"

namespace galactic::test {

// Render meshes of hand-made packs. Everything is valid as smallRenderMeshes() makes it; a test
// changes what it wants to be wrong.

struct RenderModelFields {
  std::uint32_t part = 0;
  float step = 0x1p-10F;
  std::uint32_t first_cluster = 0;
  std::uint32_t cluster_count = 0;
  std::uint32_t first_block = 0;
  bool has_bounds = true;
  Vec3 bounds_min;
  Vec3 bounds_max;
  std::uint32_t source_triangles = 0;
  std::uint32_t triangles = 0;
  float largest_error = 0.001F;
};

struct RenderMaterialFields {
  std::string name = "oak";
  std::uint32_t color = 0xFF336699;
  std::int32_t texture = -1;
  float alpha_cutoff = 0;
};

struct RenderTextureFields {
  std::string name = "oak.png";
  std::uint32_t size = 2;
  std::uint8_t format = 0;
  std::uint32_t first_byte = 0;
  /// XXH3-128 of texels in a texture pack, low half first.
  std::optional<std::pair<std::uint64_t, std::uint64_t>> shared{};
};

struct RenderMeshesFields {
  std::vector<RenderModelFields> models;
  std::vector<RenderCluster> clusters;
  std::vector<float> bounds;
  std::vector<std::uint16_t> vertices;
  std::vector<std::uint32_t> colors;
  std::vector<std::uint8_t> triangles;
  std::vector<RenderMaterialFields> materials;
  std::vector<RenderTextureFields> textures;
  std::vector<std::uint8_t> texels;
  std::vector<std::string> semantics;

  [[nodiscard]] float& bound(std::size_t lane, std::size_t row) {
    return bounds[pooledAt(lane, row, kBoundsRows)];
  }
};

/// Appends a cluster of up to 8 vertices and triangles to the last model.
void addCluster(RenderMeshesFields& fields, const std::array<std::int32_t, 3>& origin,
                const std::vector<std::array<std::uint16_t, 3>>& vertices,
                const std::vector<std::array<std::uint8_t, 3>>& triangles);

/// A model for each part: a two-sided tetrahedron and, textured, a one-sided square that faces up.
RenderMeshesFields smallRenderMeshes(const std::vector<std::uint32_t>& parts = {0});

/// Render meshes of a hand-made pack, or none.
using RenderMeshesField = std::optional<RenderMeshesFields>;

}  // namespace galactic::test
