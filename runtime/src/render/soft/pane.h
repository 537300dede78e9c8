#pragma once
#include <cstdint>

#include "render/raster/pane_task.h"

// What the kernels of the `soft` renderer read and write, as bare pointers; see pane_task.h.
namespace galactic::render {

static_assert(kMostTiles <= 32, "one bit each");

/// Records that a pane has room for. When they are used up, what is visible so far is shaded.
inline constexpr std::uint32_t kMostRecords = 16384;

/// What a thread needs to draw panes. All pointers are aligned to 64 bytes.
struct PaneScratch {
  /// 1/w by pixel: 0 where nothing is drawn, infinite outside the image.
  float* depth = nullptr;
  /// By pixel, the index of the first number of its record: 0 for the background, kShaded if the
  /// image already has the color.
  std::int32_t* ids = nullptr;
  /// Least 1/w of each tile; out of date for tiles with a bit in `tile_changed`.
  float* tile_depth = nullptr;
  /// For each row of tiles, bit n: tile n has changed since its `tile_depth` was computed.
  std::uint32_t* tile_changed = nullptr;
  /// Room for all clusters of a view.
  SeenCluster* seen = nullptr;
  std::uint32_t* order = nullptr;
  std::uint32_t* bucket_starts = nullptr;
  /// Record 0 is the background's.
  float* records = nullptr;
  float* colors = nullptr;
};
inline constexpr std::int32_t kShaded = -1;

/// What was drawn on a pane.
struct PaneCounts {
  std::uint64_t clusters = 0;
  std::uint64_t clusters_drawn = 0;
  std::uint64_t triangles_drawn = 0;
};

/// Draws a pane. All versions do the same operations in the same order, without contraction, so
/// their images agree bit for bit.
using DrawPane = PaneCounts (*)(const PaneTask&, const PaneScratch&) noexcept;
/// For any processor.
PaneCounts drawPanePortable(const PaneTask& task, const PaneScratch& scratch) noexcept;
/// For processors with AVX2.
PaneCounts drawPaneAvx2(const PaneTask& task, const PaneScratch& scratch) noexcept;
/// For processors with AVX-512: see detail::hasAvx512().
PaneCounts drawPaneAvx512(const PaneTask& task, const PaneScratch& scratch) noexcept;

}  // namespace galactic::render
