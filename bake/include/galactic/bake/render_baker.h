#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "galactic/bake/render_textures.h"
#include "galactic/bake/source_asset.h"
#include "galactic/bake/triangle_mesh.h"
#include "galactic/error.h"
#include "galactic/render_meshes.h"
#include "layout/render_pools.h"

namespace galactic::bake {

/// A mesh, placed in a part.
struct PlacedMesh {
  /// Must outlive the bake.
  const SourceMesh* mesh = nullptr;
  Affine part_from_mesh{};
  /// Index into RenderSource::materials; not that of the mesh.
  std::uint32_t material = 0;
  /// Index into RenderSource::semantics.
  std::uint32_t semantic = 0;
};

/// What is placed with one transform and becomes one RenderModel.
struct RenderPart {
  /// Index of the object in its set, or of the link in its robot; 0 for a scene.
  std::uint32_t part = 0;
  std::vector<PlacedMesh> meshes;
  /// Orientation of the part for lighting, with Y up; only the rotation is used.
  Affine light_from_part{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
};

/// What render meshes are made from.
struct RenderSource {
  /// Ascending part numbers.
  std::vector<RenderPart> parts;
  std::vector<SourceMaterial> materials;
  /// One per material: the same materials as a pack stores them.
  BakedMaterials baked;
  /// Names of the semantic ids; at least one.
  std::vector<std::string> semantics;
  /// Meshes that no asset owns: primitive shapes.
  std::vector<std::unique_ptr<SourceMesh>> own_meshes;
  /// Whether textures and vertex colors may include the light of the place, as in scans.
  bool may_hold_light = false;
  /// Bounds of the parts of a scene's free space that are its room, in the frame of its part:
  /// places where cameras may be.
  std::vector<Bounds> rooms;
};

/// Which surfaces get light that is baked into their vertex colors: a sky and a key light by
/// normal, blocked by nearby surfaces.
enum class Lighting : std::uint8_t {
  kNone,  ///< None: colors are those of the source.
  kAuto,  ///< Those without light of their own: robots, objects, and surfaces of scenes that have
          ///< neither texture nor vertex colors.
  kAll
};

struct RenderBakeOptions {
  /// How far simplification may move a surface, meters; 0 removes only needless triangles of flat
  /// faces. Small and thin pieces move less: at most kLargestShare of their extent, and
  /// kLargestThinness of their area per extent.
  double error = 0.005;
  Lighting lighting = Lighting::kAuto;

  friend bool operator==(const RenderBakeOptions&, const RenderBakeOptions&) = default;
};

/// The most that simplification moves a piece, as a fraction of its longest edge: a knob stays a
/// knob.
inline constexpr double kLargestShare = 0.05;
/// The most that simplification moves a piece, as a fraction of its area divided by its longest
/// edge, which is about the circumference of a cable or the width of a strip. Both keep two thirds
/// of their width.
inline constexpr double kLargestThinness = 0.1;

/// Statistics of a bake.
struct RenderBakeStatistics {
  std::uint64_t source_triangles = 0;
  std::uint64_t triangles = 0;
  std::uint64_t source_vertices = 0;
  std::uint64_t vertices = 0;
  std::uint64_t clusters = 0;
  std::uint64_t two_sided_triangles = 0;
  /// Bytes of the placed meshes as floats: positions, texture coordinates, colors and 32-bit
  /// indices.
  std::uint64_t source_bytes = 0;
  /// Bytes of clusters, bounds, vertices, colors and triangles.
  std::uint64_t bytes = 0;
  /// Bytes of the source's images, decoded, and of the textures as they are stored.
  std::uint64_t source_texture_bytes = 0;
  std::uint64_t texture_bytes = 0;
  /// The farthest that simplification moved a surface, meters, measured at its corners and the
  /// middles of its triangles. Includes the most that the lattice moved a corner, if that is more
  /// than a tenth of the allowed error and the lattice is not the finest.
  float largest_error = 0;

  /// Adds the statistics of another asset.
  RenderBakeStatistics& operator+=(const RenderBakeStatistics& more);
};

/// The render meshes of a pack in the layout of schema/render.fbs.
struct BakedRenderMeshes : RenderPools {
  BakedMaterials materials;
  std::vector<std::string> semantics;
  /// Statistics of the placed meshes: see RenderBakeStatistics.
  std::uint64_t source_vertices = 0;
  std::uint64_t source_bytes = 0;
  /// One sentence each. Warnings about materials are in `materials`.
  std::vector<std::string> warnings;

  /// Views into this object, which must outlive them.
  [[nodiscard]] RenderMeshes view() const;
  [[nodiscard]] RenderBakeStatistics statistics() const;
  /// Bytes in a pack.
  [[nodiscard]] std::uint64_t storedBytes() const;
};

/// Makes the render meshes of a source. It places and welds the meshes of each part, simplifies
/// each connected piece while keeping its seams (Garland and Heckbert's quadrics, with
/// meshoptimizer), decides for each piece whether it must be visible from both sides, puts the
/// corners on one lattice per model, and cuts clusters in spatial order. Light is added after
/// simplification, so that neither interferes with the other.
///
/// Pieces touch at equal corners, whatever their materials, so no cracks open between materials or
/// clusters. Closed pieces of two-sided materials become one-sided, and their triangles are flipped
/// to face outward if necessary, unless they are as large as a room or contain one, because a
/// camera may be inside.
///
/// Fails with kInvalidInput if a corner is not finite or beyond kMaxCoordinate (`where` names the
/// mesh), or if a material or semantic id does not exist, and with kUnsupported if there are more
/// than 65,536 materials or semantic ids. The result depends neither on `threads` nor on the
/// processor.
[[nodiscard]] Result<BakedRenderMeshes> bakeRenderMeshes(const RenderSource& source,
                                                         const RenderBakeOptions& options,
                                                         unsigned threads = 1);

/// Appends the models of `more` to `meshes`, with part numbers from `part` on. Equal textures and
/// equal names of semantic ids are shared. Together they may have at most 65,536 materials and as
/// many names.
void append(BakedRenderMeshes& meshes, const BakedRenderMeshes& more, std::uint32_t part);

/// Appends `more` to `materials`, sharing equal textures. Returns the index of its first material.
std::uint32_t append(BakedMaterials& materials, const BakedMaterials& more);

}  // namespace galactic::bake
