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

/// A vertex as it lies in the vertex buffer: all that the vertex shader needs, whatever cluster it
/// is of, so that neighboring clusters can be drawn as one.
struct GpuVertex {
  /// Meters in the frame of the model: float(origin + stored) * step, so the same for all clusters
  /// that share the point.
  float x = 0;
  float y = 0;
  float z = 0;
  /// Texture coordinates, v down.
  float u = 0;
  float v = 0;
  /// RGBA, R lowest: of the vertex, times the material's where there is no texture.
  std::uint32_t color = 0xFFFFFFFF;
  /// Where the texture lies, see textureSlot(); kNoTexture for none.
  std::uint32_t texture = 0;
  /// As in images.
  std::uint32_t semantic = 0;
  float alpha_cutoff = 0;
};

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
/// likewise, so that the indices of neighboring clusters of a class follow each other.
struct LibraryGeometry {
  std::vector<ModelClusters> models;
  /// Whether any vertices have colors of their own.
  bool vertex_colors = false;
  std::vector<GpuBounds> bounds;
  std::vector<GpuVertex> vertices;
  std::vector<std::uint32_t> indices;
};

/// `texture_slots`: for each pack of the library the slots of its textures.
[[nodiscard]] LibraryGeometry gatherGeometry(
    const RenderLibrary& library, std::span<const std::vector<std::uint32_t>> texture_slots);

}  // namespace galactic::render::gl
