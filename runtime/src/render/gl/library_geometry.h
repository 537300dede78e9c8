#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "galactic/render_library.h"

namespace galactic::render::gl {

/// Clusters of a class are drawn with the same program and the same face culling.
enum class DrawClass : std::uint8_t { kOneSided, kTwoSided, kMaskedOneSided, kMaskedTwoSided };
inline constexpr std::size_t kDrawClasses = 4;

/// A vertex of the vertex buffer. It has all that the vertex shader needs, whichever cluster it
/// belongs to, so that neighboring clusters can be drawn with one command.
struct GpuVertex {
  /// Meters in the frame of the model: float(origin + stored) * step, and so the same in all
  /// clusters that share the point.
  float x = 0;
  float y = 0;
  float z = 0;
  /// Texture coordinates, v down.
  float u = 0;
  float v = 0;
  /// RGBA, R lowest: the vertex's color, times the material's if it has no texture.
  std::uint32_t color = 0xFFFFFFFF;
  /// Where the texture lies, see textureSlot(); kNoTexture for none.
  std::uint32_t texture = 0;
  /// The semantic id that images show.
  std::uint32_t semantic = 0;
  float alpha_cutoff = 0;
};

/// What culling reads about a cluster (std430): its bounds as in RenderMeshes, and its indices.
struct GpuBounds {
  std::array<float, kBoundsRows> rows{};
  std::uint32_t first_index = 0;
  std::uint32_t index_count = 0;
};
static_assert(sizeof(GpuBounds) == 52);

/// The clusters of a model, by class: those of class c are numbers first[c] to first[c + 1] - 1.
struct ModelClusters {
  std::array<std::uint32_t, kDrawClasses + 1> first{};

  [[nodiscard]] std::uint32_t count() const { return first[kDrawClasses] - first[0]; }
};

/// The geometry of a whole library in the layout of the graphics processor. Clusters are sorted by
/// model, then by class, then as in the pack, and their triangles likewise, so that the indices of
/// neighboring clusters of a class are consecutive.
struct LibraryGeometry {
  std::vector<ModelClusters> models;
  /// Whether any vertex has a color of its own.
  bool vertex_colors = false;
  std::vector<GpuBounds> bounds;
  std::vector<GpuVertex> vertices;
  std::vector<std::uint32_t> indices;
};

/// `texture_slots`: for each pack of the library, the slots of its textures, see textureSlot().
[[nodiscard]] LibraryGeometry gatherGeometry(
    const RenderLibrary& library, std::span<const std::vector<std::uint32_t>> texture_slots);

}  // namespace galactic::render::gl
