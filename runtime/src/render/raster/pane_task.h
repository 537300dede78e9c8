#pragma once
#include <cstddef>
#include <cstdint>

#include "galactic/render_meshes.h"

/// Of functions that run on the processor and on devices: clang and nvcc have to be told.
#if defined(__CUDA__) || defined(__CUDACC__)
#define GALACTIC_EVERYWHERE __attribute__((host)) __attribute__((device))
#else
#define GALACTIC_EVERYWHERE
#endif

// What rasterizers read, as bare pointers and plain numbers: the code
// built for AVX2 must not instantiate library templates, which the linker could then share with
// code for any processor.
namespace galactic::render {

/// Images are drawn in panes of at most this edge, so that what a pane needs stays in the cache.
inline constexpr std::uint32_t kPaneEdge = 256;
/// Pixels are stored in blocks of 4 x 2, which are one vector; rows of blocks follow each other.
inline constexpr std::uint32_t kBlockWidth = 4;
inline constexpr std::uint32_t kBlockHeight = 2;
/// Edge of the squares that the hierarchical depth test looks at.
inline constexpr std::uint32_t kTileEdge = 8;
inline constexpr std::uint32_t kMostTiles = kPaneEdge / kTileEdge;

/// Lattice points per pixel to which vertices are moved: what makes edge functions exact.
inline constexpr std::int32_t kSubpixels = 256;
inline constexpr std::int32_t kHalfPixel = kSubpixels / 2;

/// How a material looks to the shader.
struct SurfaceTexels {
  /// Flat: the color, RGBA, R lowest. Else the number of the first texel, from the base.
  std::uint32_t texels = 0;
  /// kFlatSurface, or log2 of the edge of the texture and, in bits 8 to 29, the number of the base.
  std::uint32_t kind = 0;
  /// What has less alpha than this, of 255, is not there. 0: opaque.
  std::uint32_t least_alpha = 0;
};
inline constexpr std::uint32_t kFlatSurface = 0xFF;
/// Bits of a triangle's kind: its corners have colors; or shades of gray, as light has that is
/// baked into them, which take a quarter of the work.
inline constexpr std::uint32_t kHasColors = 1U << 31U;
inline constexpr std::uint32_t kHasLight = 1U << 30U;

/// The pools of one pack.
struct PackTables {
  const RenderCluster* clusters = nullptr;
  const float* cluster_bounds = nullptr;
  const std::uint16_t* vertices = nullptr;
  /// Null where there are none.
  const std::uint32_t* colors = nullptr;
  /// For each cluster kHasColors, kHasLight or, where all is white, 0. Null where there are none.
  const std::uint32_t* color_kinds = nullptr;
  const std::uint8_t* triangles = nullptr;
  const SurfaceTexels* surfaces = nullptr;
  /// Semantic id in images of the pack's semantic 0.
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
/// camera's axis, and to X and Y: X / w and Y / w count in 1/256 pixels from the image's center, to
/// the right and down.
struct PlacedModel {
  const ModelTables* model = nullptr;
  float w[4] = {};
  float x[4] = {};
  float y[4] = {};
  /// In images, of all its clusters; or kSemanticsOfPack.
  std::uint32_t semantic = kSemanticsOfPack;
};

/// A part of an image that is drawn by itself, pixels.
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
  /// Of the whole image, pixels.
  std::uint32_t image_width = 0;
  std::uint32_t image_height = 0;
  /// The pane within it.
  std::uint32_t left = 0;
  std::uint32_t top = 0;
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  float near = 0;
  std::uint32_t background = 0;
  bool culling = true;
  /// The image: null where it is not wanted. `channels`: 3 or 4.
  std::uint8_t* color = nullptr;
  std::uint32_t channels = 4;
  float* depth = nullptr;
  std::uint32_t* semantics = nullptr;
};

/// A cluster that may be seen.
struct SeenCluster {
  /// Index into PaneTask::models.
  std::uint32_t model = 0;
  /// Within its model.
  std::uint32_t cluster = 0;
  /// At least the largest 1/w of it; infinite when it comes too near.
  float nearest = 0;
  /// The tiles that it can touch: first and last column, first and last row.
  std::uint8_t tiles[4] = {};
  /// By distance: nearer ones have a lower number.
  std::uint32_t bucket = 0;
};
inline constexpr std::uint32_t kBuckets = 512;

/// Numbers in a record: a triangle that is shaded later. Texture coordinates are in texels of the
/// largest level.
enum RecordField : std::uint32_t {
  kURight,  ///< Change of u / w with each pixel to the right.
  kUDown,   ///< With each pixel down.
  kUStart,  ///< At the center of the pane's first pixel.
  kVRight,
  kVDown,
  kVStart,
  kWRight,  ///< Of 1 / w.
  kWDown,
  kTexels,  ///< SurfaceTexels::texels; this field and the next two hold integers.
  kKind,
  kSemantic,
  kRecordFields = 12,
  /// Plane of the light: behind what all records have.
  kLightRight = 12,
  kLightDown,
  kLightStart
};
/// Fields of the colors' planes: red, green, blue, alpha, each as right, down, start.
inline constexpr std::uint32_t kColorFields = 12;
/// From one record to the next: a cache line.
inline constexpr std::uint32_t kRecordStride = 16;

}  // namespace galactic::render
