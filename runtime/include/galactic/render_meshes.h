#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "galactic/error.h"
#include "galactic/pack.h"
#include "galactic/pose.h"

namespace galactic {

/// How texels are stored.
enum class TexelFormat : std::uint8_t {
  kRgba8,  ///< R, G, B (sRGB), A: a byte each.
  kBc1,    ///< Blocks of 4x4 texels in 8 bytes, sRGB, without alpha.
};

/// A square image with all mip levels, down to one texel.
struct RenderTexture {
  std::string_view name;
  /// Edge of the largest level, texels: a power of two.
  std::uint32_t size = 0;
  TexelFormat format = TexelFormat::kRgba8;
  /// Largest level first, without gaps; rows from the image's top to its bottom.
  std::span<const std::uint8_t> texels;
};

/// Bytes of a texture with all its mip levels. `size`: a power of two.
[[nodiscard]] std::size_t textureBytes(std::uint32_t size, TexelFormat format);

/// A surface appearance, unlit.
struct RenderMaterial {
  std::string_view name;
  /// RGBA, sRGB, 8 bits each, R in the lowest byte; not used if there is a texture.
  std::uint32_t color = 0xFFFFFFFF;
  /// Index of a texture, or -1.
  std::int32_t texture = -1;
  /// 0: opaque; otherwise texels with less alpha than this are not drawn.
  float alpha_cutoff = 0;
};

/// In place of a semantic id: each cluster of a model has the id that its pack gives it.
inline constexpr std::uint32_t kSemanticsOfPack = 0xFFFFFFFF;

/// Up to kMostInCluster vertices and triangles of one material that are drawn or culled together.
/// The memory layout is that of a pack.
struct RenderCluster {
  /// Origin of its vertices' coordinates on its model's lattice, in steps.
  std::int32_t origin_x = 0;
  std::int32_t origin_y = 0;
  std::int32_t origin_z = 0;
  /// Texture coordinates: value = minimum + step * stored. v runs down from the image's top; images
  /// repeat.
  float u_minimum = 0;
  float v_minimum = 0;
  float u_step = 0;
  float v_step = 0;
  /// Multiples of 8.
  std::uint32_t first_vertex = 0;
  std::uint32_t first_triangle = 0;
  std::uint16_t vertex_count = 0;
  std::uint16_t triangle_count = 0;
  /// Indices into materials and semantics.
  std::uint16_t material = 0;
  std::uint16_t semantic = 0;
  /// 1: seen from both sides. 0: from outside only, where the corners go counter-clockwise.
  std::uint16_t two_sided = 0;
  std::uint16_t reserved = 0;
};

/// The largest number of vertices, and of triangles, in a cluster.
inline constexpr std::size_t kMostInCluster = 128;
/// Clusters' bounds, vertices and triangles are stored in groups of eight, which are read at once.
inline constexpr std::size_t kRenderLanes = 8;
/// Rows of a block of bounds: box center x, y, z; half extents x, y, z; radius; cone axis x, y, z;
/// cone cutoff. schema/render.fbs explains them.
inline constexpr std::size_t kBoundsRows = 11;
/// Rows of eight vertices: x, y, z on the lattice, counted from the cluster's origin; u, v.
inline constexpr std::size_t kVertexRows = 5;
/// Rows of eight triangles: the corners, as numbers of vertices in the cluster.
inline constexpr std::size_t kTriangleRows = 3;

/// What is placed with one transform: a scene, an object, the geometry of one link.
struct RenderModel {
  /// Index of the object in its set, or of the link in its robot; 0 for a scene.
  std::uint32_t part = 0;
  /// Meters between neighboring lattice points: a power of two. The vertex (x, y, z) of a cluster
  /// stands at step * (origin + (x, y, z)), exactly.
  float step = 0;
  std::uint32_t first_cluster = 0;
  std::uint32_t cluster_count = 0;
  /// Bounds of cluster first_cluster + i are in block first_block + i / 8, lane i % 8.
  std::uint32_t first_block = 0;
  /// Axis-aligned, meters, in the frame of the part.
  Vec3 bounds_min;
  Vec3 bounds_max;
  std::uint32_t source_triangles = 0;
  std::uint32_t triangles = 0;
  /// The farthest that simplification moved the surface, together with a lattice that is coarse
  /// compared with that; meters.
  float largest_error = 0;
};

/// A texture in a texture pack.
struct MissingTexture {
  std::string_view name;
  /// XXH3-128 of its texels.
  std::uint64_t hash_low = 0;
  std::uint64_t hash_high = 0;
};

/// Everything in a pack that can be drawn: views into its memory, in the layout of
/// schema/render.fbs.
struct RenderMeshes {
  /// Ascending `part`.
  std::vector<RenderModel> models;
  std::span<const RenderCluster> clusters;
  /// Shape: blocks x kBoundsRows x 8.
  std::span<const float> cluster_bounds;
  /// Shape: vertices / 8 x kVertexRows x 8.
  std::span<const std::uint16_t> vertices;
  /// Colors that multiply the material's: RGBA, sRGB, R in the lowest byte; one per vertex, or
  /// none.
  std::span<const std::uint32_t> colors;
  /// Shape: triangles / 8 x kTriangleRows x 8.
  std::span<const std::uint8_t> triangles;
  std::vector<RenderMaterial> materials;
  std::vector<RenderTexture> textures;
  /// Names of the semantic ids.
  std::vector<std::string_view> semantics;
  /// Textures that are in other packs and were not found: their materials have plain colors.
  std::vector<MissingTexture> missing_textures;

  /// The model of this object or link; none if it has nothing to show.
  [[nodiscard]] std::optional<std::uint32_t> modelOf(std::uint32_t part) const;
};

class SharedTextures;

/// The render meshes of a scene, object or robot pack, which must outlive them; none if it was
/// baked without. Textures that the pack shares with others come from `shared`, whose packs must
/// also outlive the meshes. Fails with kInvalidInput if it is another kind of pack.
[[nodiscard]] Result<std::optional<RenderMeshes>> renderMeshesOf(const PackFile& pack,
                                                                 const SharedTextures& shared);

/// The same, without any shared textures.
[[nodiscard]] Result<std::optional<RenderMeshes>> renderMeshesOf(const PackFile& pack);

}  // namespace galactic
