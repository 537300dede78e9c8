#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "galactic/render_library.h"

namespace galactic::render::gl {

/// Clusters that are drawn with the same program and the same culling of faces.
enum class DrawClass : std::uint8_t { kOneSided, kTwoSided, kMaskedOneSided, kMaskedTwoSided };
inline constexpr std::size_t kDrawClasses = 4;

/// A vertex as it lies in the vertex buffer.
struct GpuVertex {
  /// On the lattice, counted from the cluster's origin.
  std::uint16_t x = 0;
  std::uint16_t y = 0;
  std::uint16_t z = 0;
  /// Low bits of its cluster's number, so that neighbouring clusters can be drawn as one.
  std::uint16_t cluster = 0;
  std::uint16_t u = 0;
  std::uint16_t v = 0;
  std::uint32_t color = 0xFFFFFFFF;
};
static_assert(sizeof(GpuVertex) == 16);

/// What the vertex shader reads of a cluster (std430).
struct GpuCluster {
  std::int32_t origin_x = 0;
  std::int32_t origin_y = 0;
  std::int32_t origin_z = 0;
  float step = 0;
  float u_minimum = 0;
  float v_minimum = 0;
  float u_step = 0;
  float v_step = 0;
  /// Of the material; white where there is a texture.
  std::uint32_t color = 0xFFFFFFFF;
  /// Where the texture lies, see TextureSlot; kNoTexture for none.
  std::uint32_t texture = 0;
  float alpha_cutoff = 0;
  /// As in images.
  std::uint32_t semantic = 0;
};
static_assert(sizeof(GpuCluster) == 48);

/// What culling reads of a cluster (std430): its bounds as in RenderMeshes, and its indices.
struct GpuBounds {
  std::array<float, kBoundsRows> rows{};
  std::uint32_t first_index = 0;
  std::uint32_t index_count = 0;
};
static_assert(sizeof(GpuBounds) == 52);

/// The clusters of a model, by class: class c has first[c] up to first[c + 1].
struct ModelClusters {
  std::array<std::uint32_t, kDrawClasses + 1> first{};

  [[nodiscard]] std::uint32_t count() const { return first[kDrawClasses] - first[0]; }
};

/// The geometry of a whole library in the layout of the graphics processor. Clusters stand in the
/// order of their models, within a model by class, within a class as in the pack; their triangles
/// likewise, so that the indices of neighbouring clusters of a class follow each other.
struct LibraryGeometry {
  std::vector<ModelClusters> models;
  std::vector<GpuCluster> clusters;
  std::vector<GpuBounds> bounds;
  std::vector<GpuVertex> vertices;
  std::vector<std::uint32_t> indices;
};

/// `texture_slots`: for each pack of the library the slots of its textures.
[[nodiscard]] LibraryGeometry gatherGeometry(
    const RenderLibrary& library, std::span<const std::vector<std::uint32_t>> texture_slots);

}  // namespace galactic::render::gl
