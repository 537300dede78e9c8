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

/// A mesh at its place in a part.
struct PlacedMesh {
  /// Outlives the bake.
  const SourceMesh* mesh = nullptr;
  Affine part_from_mesh{};
  /// Index into RenderSource::materials; not that of the mesh.
  std::uint32_t material = 0;
  /// Index into RenderSource::semantics.
  std::uint32_t semantic = 0;
};

/// What is placed with one transform and becomes one RenderModel.
struct RenderPart {
  /// Of the object in its set, or of the link in its robot; 0 for a scene.
  std::uint32_t part = 0;
  std::vector<PlacedMesh> meshes;
  /// How the part stands while it is lit; only the rotation counts. Y is up.
  Affine light_from_part{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
};

/// What render meshes are made of.
struct RenderSource {
  /// Ascending part numbers.
  std::vector<RenderPart> parts;
  std::vector<SourceMaterial> materials;
  /// One per material: the same materials as a pack stores them.
  BakedMaterials baked;
  /// Names of what semantic ids tell apart; at least one.
  std::vector<std::string> semantics;
  /// Meshes that no asset owns: primitive shapes.
  std::vector<std::unique_ptr<SourceMesh>> own_meshes;
  /// Whether textures and vertex colors may hold the light of the place, as those of scans do.
  bool may_hold_light = false;
  /// Bounds of the parts of a scene's free space that are its room, in the frame of its part: there
  /// cameras may be.
  std::vector<Bounds> rooms;
};

/// Which surfaces get light, baked into their vertex colors: a sky and a key light by normal, kept
/// away by what is near.
enum class Lighting : std::uint8_t {
  kNone,  ///< Colors as the source gives them.
  kAuto,  ///< Those without light of their own: robots and objects, and in scenes what has neither
          ///< texture nor vertex colors.
  kAll
};

struct RenderBakeOptions {
  /// How far simplification may move a surface, meters; 0 leaves all but the needless triangles of
  /// flat faces alone. Small and thin pieces move less: at most kLargestShare of their extent, and
  /// kLargestThinness of their area per extent.
  double error = 0.005;
  Lighting lighting = Lighting::kAuto;

  friend bool operator==(const RenderBakeOptions&, const RenderBakeOptions&) = default;
};

/// Most that simplification moves a piece, as a share of its longest edge: a knob stays a knob.
inline constexpr double kLargestShare = 0.05;
/// Most that simplification moves a piece, as a share of its area divided by its longest edge: that
/// is about the circumference of a cable, the width of a strip. Both keep two thirds of their
/// width.
inline constexpr double kLargestThinness = 0.1;

/// Figures of a bake.
struct RenderBakeStatistics {
  std::uint64_t source_triangles = 0;
  std::uint64_t triangles = 0;
  std::uint64_t source_vertices = 0;
  std::uint64_t vertices = 0;
  std::uint64_t clusters = 0;
  std::uint64_t two_sided_triangles = 0;
  /// Of the placed meshes as floats: positions, texture coordinates, colors and 32-bit indices.
  std::uint64_t source_bytes = 0;
  /// Clusters, bounds, vertices, colors and triangles.
  std::uint64_t bytes = 0;
  /// Images as they came, decoded; and as they are stored.
  std::uint64_t source_texture_bytes = 0;
  std::uint64_t texture_bytes = 0;
  /// Farthest that simplification moved a surface, as measured at its corners and the middles of
  /// its triangles; with the most that the lattice moved a corner, where that is more than a tenth
  /// of the error allowed and the lattice is not the finest. Meters.
  float largest_error = 0;

  /// Of several assets together.
  RenderBakeStatistics& operator+=(const RenderBakeStatistics& more);
};

/// The render meshes of a pack in the layout of schema/render.fbs.
struct BakedRenderMeshes : RenderPools {
  BakedMaterials materials;
  std::vector<std::string> semantics;
  /// Of the placed meshes: see RenderBakeStatistics.
  std::uint64_t source_vertices = 0;
  std::uint64_t source_bytes = 0;
  /// One sentence each. Those of the materials are theirs.
  std::vector<std::string> warnings;

  /// Views into this, which must outlive it.
  [[nodiscard]] RenderMeshes view() const;
  [[nodiscard]] RenderBakeStatistics statistics() const;
  /// Bytes in a pack.
  [[nodiscard]] std::uint64_t storedBytes() const;
};

/// Makes the render meshes of a source: places and welds the meshes of each part, simplifies each
/// connected piece (Garland and Heckbert's quadrics, through meshoptimizer) with its seams kept,
/// decides for each piece whether it needs to be seen from both sides, puts the corners on one
/// lattice per model, and cuts clusters in spatial order. Light is added after simplification, so
/// that neither stands in the other's way.
///
/// Pieces touch at equal corners, whatever their materials, so no crack opens between materials or
/// clusters. Closed pieces of two-sided materials become one-sided, and are turned outside out if
/// need be, unless they are as large as a room or hold one: a camera may be inside.
///
/// Fails with kInvalidInput where a corner is not finite or beyond kMaxCoordinate (`where` names
/// the mesh), and when a material or semantic does not exist; with kUnsupported when there are more
/// than 65,536 materials or semantics. The result depends neither on `threads` nor on the
/// processor.
[[nodiscard]] Result<BakedRenderMeshes> bakeRenderMeshes(const RenderSource& source,
                                                         const RenderBakeOptions& options,
                                                         unsigned threads = 1);

/// Appends the models of `more` to `meshes`, numbered from `part` on. Equal textures and equal
/// names of semantics are shared. Together they have at most 65,536 materials and as many names.
void append(BakedRenderMeshes& meshes, const BakedRenderMeshes& more, std::uint32_t part);

/// Appends `more` to `materials`, sharing equal textures. Returns the index of its first material.
std::uint32_t append(BakedMaterials& materials, const BakedMaterials& more);

}  // namespace galactic::bake
