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

/// The largest texture coordinate that buildRenderMeshes() takes, by magnitude: a cluster then
/// repeats its image 32,000 times at most, which a pack can hold.
inline constexpr float kMostImages = 16000;

/// A corner of triangles to draw.
struct RenderVertex {
  /// Meters, in the frame of the part.
  Vec3 position;
  /// Texture coordinates: u to the right, v down from the image's top; images repeat.
  float u = 0;
  float v = 0;
  /// RGBA, sRGB, R lowest, that multiplies the material's.
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
  /// Whether the triangles are seen from inside, too.
  bool two_sided = false;
};

/// What is placed with one transform.
struct RenderPart {
  /// Of the object in its set, or of the link in its robot; 0 for a scene.
  std::uint32_t part = 0;
  std::vector<RenderSurface> surfaces = {};
  /// What is stored beside the geometry: triangles of the source, and how far simplification moved
  /// the surface, meters.
  std::uint32_t source_triangles = 0;
  float largest_error = 0;
};

/// What buildRenderMeshes() makes render meshes of. Names and texels belong to the caller.
struct RenderMeshSource {
  /// Ascending `part`.
  std::vector<RenderPart> parts;
  std::vector<RenderMaterial> materials;
  std::vector<RenderTexture> textures;
  std::vector<std::string> semantics;
};

/// Render meshes in memory of their own, in the layout of a pack.
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
    /// In texels, a multiple of 32.
    std::size_t first_byte = 0;
  };

  std::vector<Material> materials;
  std::vector<Texture> textures;
  Values<std::uint8_t> texels;
  std::vector<std::string> semantics;

  /// The same as views, which this must outlive.
  [[nodiscard]] RenderMeshes view() const;
};

/// Puts triangles into the layout of schema/render.fbs. A surface of at most kMostInCluster
/// vertices and triangles becomes one cluster, in the order given; a larger one is split into
/// compact clusters, and vertices that no triangle uses are left out. A surface without triangles
/// becomes nothing. Positions are rounded to the lattice of their part: the finest with a step of
/// 2^-14 m or more that every cluster fits on, so equal positions stay equal across clusters.
/// Bounds hold what is drawn, rounded outwards; one-sided clusters get a cone of normals where they
/// have one. Colors are left out when all are white. The same source gives the same bytes. Fails
/// with kInvalidInput, naming part and surface, on numbers that are not finite or too large for the
/// layout, on indices out of range, on parts that do not ascend, and on textures that are no power
/// of two or have the wrong number of bytes.
[[nodiscard]] Result<RenderMeshStorage> buildRenderMeshes(const RenderMeshSource& source);

}  // namespace galactic
