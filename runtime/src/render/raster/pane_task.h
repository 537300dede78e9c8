#pragma once
#include <cstddef>
#include <cstdint>

#include "galactic/render_meshes.h"

/// Marks functions that run on the processor and on devices, for clang and nvcc.
#if defined(__CUDA__) || defined(__CUDACC__)
#define GALACTIC_EVERYWHERE __attribute__((host)) __attribute__((device))
#else
#define GALACTIC_EVERYWHERE
#endif

// What rasterizers read, as bare pointers and plain numbers: code built for AVX2 must not
// instantiate library templates, because the linker could then share them with code for any
// processor.
namespace galactic::render {

/// Images are drawn in panes whose edges are no longer than this, pixels, so that the data of a
/// pane stays in the cache.
inline constexpr std::uint32_t kPaneEdge = 256;
/// Pixels are stored in blocks of 4 x 2, each of which is one vector; the blocks are stored row by
/// row.
inline constexpr std::uint32_t kBlockWidth = 4;
inline constexpr std::uint32_t kBlockHeight = 2;
/// Edge of the squares of the hierarchical depth test, pixels.
inline constexpr std::uint32_t kTileEdge = 8;
inline constexpr std::uint32_t kMostTiles = kPaneEdge / kTileEdge;

/// Vertices are moved to a lattice with this many points per pixel, so that edge functions are
/// exact.
inline constexpr std::int32_t kSubpixels = 256;
inline constexpr std::int32_t kHalfPixel = kSubpixels / 2;

/// How a material looks to the shader.
struct SurfaceTexels {
  /// For a flat surface its color, RGBA, R lowest; otherwise the number of the first texel, counted
  /// from the base.
  std::uint32_t texels = 0;
  /// kFlatSurface, or log2 of the edge of the texture and, in bits 8 to 29, the number of the base.
  std::uint32_t kind = 0;
  /// Texels with less alpha than this (of 255) are holes. 0: opaque.
  std::uint32_t least_alpha = 0;
};
inline constexpr std::uint32_t kFlatSurface = 0xFF;
/// Bits of a triangle's kind. Its corners have colors, or only shades of gray, as baked light has,
/// which take a quarter of the work.
inline constexpr std::uint32_t kHasColors = 1U << 31U;
inline constexpr std::uint32_t kHasLight = 1U << 30U;

/// The pools of one pack.
struct PackTables {
  const RenderCluster* clusters = nullptr;
  const float* cluster_bounds = nullptr;
  const std::uint16_t* vertices = nullptr;
  /// Null if there are none.
  const std::uint32_t* colors = nullptr;
  /// For each cluster kHasColors, kHasLight or, if all its vertices are white, 0. Null if the pack
  /// has no colors.
  const std::uint32_t* color_kinds = nullptr;
  const std::uint8_t* triangles = nullptr;
  const SurfaceTexels* surfaces = nullptr;
  /// The id that images show for the pack's semantic 0.
  std::uint32_t first_semantic = 0;
};

struct ModelTables {
  const PackTables* pack = nullptr;
  float step = 0;
  std::uint32_t first_cluster = 0;
  std::uint32_t cluster_count = 0;
  std::uint32_t first_block = 0;
  /// Meters, in the frame of the part.
  float center[3] = {};
  float half_extents[3] = {};
};

/// A model in front of the camera. The rows take a point of the model to w, meters along the
/// camera's axis, and to X and Y: X / w and Y / w are 1/256 pixels from the image's center, to the
/// right and down.
struct PlacedModel {
  const ModelTables* model = nullptr;
  float w[4] = {};
  float x[4] = {};
  float y[4] = {};
  /// The id that images show for all its clusters, or kSemanticsOfPack.
  std::uint32_t semantic = kSemanticsOfPack;
};

/// A part of an image that is drawn separately, pixels.
struct PaneRectangle {
  std::uint32_t left = 0;
  std::uint32_t top = 0;
  std::uint32_t width = 0;
  std::uint32_t height = 0;
};

/// One pane of one image.
struct PaneTask {
  const PlacedModel* models = nullptr;
  std::uint32_t model_count = 0;
  /// Bases of texels, by the numbers in SurfaceTexels::kind.
  const std::uint32_t* const* texel_bases = nullptr;
  /// Size of the whole image, pixels.
  std::uint32_t image_width = 0;
  std::uint32_t image_height = 0;
  /// The pane within the image, pixels.
  std::uint32_t left = 0;
  std::uint32_t top = 0;
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  float near = 0;
  std::uint32_t background = 0;
  bool culling = true;
  /// The whole images, null if not wanted. `channels`: 3 or 4.
  std::uint8_t* color = nullptr;
  std::uint32_t channels = 4;
  float* depth = nullptr;
  std::uint32_t* semantics = nullptr;
};

/// A cluster that may be visible.
struct SeenCluster {
  /// Index into PaneTask::models.
  std::uint32_t model = 0;
  /// Within its model.
  std::uint32_t cluster = 0;
  /// An upper bound of its 1/w; infinite if it comes too near.
  float nearest = 0;
  /// The tiles that the cluster can touch: first and last column, first and last row.
  std::uint8_t tiles[4] = {};
  /// Nearer clusters have lower buckets.
  std::uint32_t bucket = 0;
};
inline constexpr std::uint32_t kBuckets = 512;

/// Numbers of a record, which is a triangle that is shaded later. Texture coordinates are in texels
/// of the largest level.
enum RecordField : std::uint32_t {
  kURight,  ///< Change of u / w per pixel to the right.
  kUDown,   ///< Per pixel down.
  kUStart,  ///< At the center of the pane's first pixel.
  kVRight,
  kVDown,
  kVStart,
  kWRight,  ///< Change of 1 / w per pixel to the right.
  kWDown,
  kTexels,  ///< SurfaceTexels::texels; this field and the next two hold integers.
  kKind,
  kSemantic,
  kRecordFields = 12,
  /// The plane of the light follows the fields that all records have.
  kLightRight = 12,
  kLightDown,
  kLightStart
};
/// Fields of the planes of the colors: red, green, blue and alpha, each with right, down and start.
inline constexpr std::uint32_t kColorFields = 12;
/// From one record to the next, in numbers: a cache line.
inline constexpr std::uint32_t kRecordStride = 16;

}  // namespace galactic::render
