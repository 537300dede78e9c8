#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "galactic/error.h"
#include "galactic/pose.h"
#include "galactic/render_meshes.h"
#include "layout/render_pools.h"

namespace galactic {

/// The largest magnitude of a texture coordinate that buildRenderMeshes() accepts: a cluster then
/// repeats its image at most 32,000 times, which a pack can store.
inline constexpr float kMostImages = 16000;

/// A corner of triangles to draw.
struct RenderVertex {
  /// Meters, in the frame of the part.
  Vec3 position;
  /// Texture coordinates: u to the right, v down from the top of the image; images repeat.
  float u = 0;
  float v = 0;
  /// RGBA, sRGB, R lowest; multiplies the material's color.
  std::uint32_t color = 0xFFFFFFFF;
};

/// Triangles of one appearance.
struct RenderSurface {
  std::vector<RenderVertex> vertices;
  /// Three per triangle: indices into vertices, counter-clockwise as seen from outside.
  std::vector<std::uint32_t> corners;
  /// Indices into RenderMeshSource::materials and semantics.
  std::uint16_t material = 0;
  std::uint16_t semantic = 0;
  /// Whether the triangles are visible from inside, too.
  bool two_sided = false;
};

/// Surfaces that are placed with one transform.
struct RenderPart {
  /// Index of the object in its set, or of the link in its robot; 0 for a scene.
  std::uint32_t part = 0;
  std::vector<RenderSurface> surfaces = {};
  /// Stored beside the geometry: triangles of the source, and how far simplification moved the
  /// surface, meters.
  std::uint32_t source_triangles = 0;
  float largest_error = 0;
};

/// The input of buildRenderMeshes(). The caller owns names and texels.
struct RenderMeshSource {
  /// In ascending order of `part`.
  std::vector<RenderPart> parts;
  std::vector<RenderMaterial> materials;
  std::vector<RenderTexture> textures;
  std::vector<std::string> semantics;
};

/// Render meshes that own their memory, in the layout of a pack.
struct RenderMeshStorage : RenderPools {
  struct Material {
    std::string name;
    std::uint32_t color = 0;
    std::int32_t texture = -1;
    float alpha_cutoff = 0;
  };
  struct Texture {
    std::string name;
    std::uint32_t size = 0;
    TexelFormat format = TexelFormat::kRgba8;
    /// Index into `texels`, a multiple of 32.
    std::size_t first_byte = 0;
  };

  std::vector<Material> materials;
  std::vector<Texture> textures;
  Values<std::uint8_t> texels;
  std::vector<std::string> semantics;

  /// Views of the same; this object must outlive them.
  [[nodiscard]] RenderMeshes view() const;
};

/// Puts triangles into the layout of schema/render.fbs. A surface of at most kMostInCluster
/// vertices and triangles becomes one cluster, in the given order; a larger one is split into
/// compact clusters, and vertices that no triangle uses are dropped. A surface without triangles
/// yields nothing. Positions are rounded to the lattice of their part: the finest lattice, with a
/// step of at least 2^-14 m, that every cluster fits on, so equal positions stay equal across
/// clusters. Bounds contain what is drawn, rounded outward; one-sided clusters get a cone of
/// normals if they have one. Colors are left out when all are white. The same source yields the
/// same bytes. Fails with kInvalidInput, naming part and surface, for numbers that are not finite
/// or too large for the layout, indices out of range, parts that do not ascend, and textures whose
/// size is not a power of two or whose number of bytes is wrong.
[[nodiscard]] Result<RenderMeshStorage> buildRenderMeshes(const RenderMeshSource& source);

}  // namespace galactic
