// Draws a pane. pane_portable.cpp, pane_avx2.cpp and pane_avx512.cpp include this file, each after
// the vectors of the instructions that it may use. Use no library templates here or in the files
// that this one includes; see column_grid_avx2.cpp. Each of these files builds on those before it.
// clang-format off
#include "render/raster/cull.inl"
#include "render/raster/vertices.inl"
#include "render/raster/triangles.inl"
#include "render/raster/sample.inl"
#include "render/raster/records.inl"
#include "render/raster/large.inl"
#include "render/raster/clip.inl"
#include "render/soft/pane_state.inl"
#include "render/soft/clusters.inl"
#include "render/soft/coverage.inl"
#include "render/soft/triangles.inl"
#include "render/soft/records.inl"
#include "render/soft/resolve.inl"
#include "render/soft/large_group.inl"
#include "render/soft/large.inl"
// clang-format on

namespace galactic::render {
namespace {

/// Empties the pane. Pixels beyond the image count as covered by something very near.
void clearPane(const Pane& pane) {
  const PaneTask& task = *pane.task;
  const PaneScratch& scratch = *pane.scratch;
  const std::uint32_t tiles_down = (task.height + kTileEdge - 1) / kTileEdge;
  const std::size_t blocks = std::size_t{pane.columns} * pane.rows;
  __builtin_memset(scratch.ids, 0, blocks * kWidth * sizeof(*scratch.ids));
  __builtin_memset(scratch.depth, 0, blocks * kWidth * sizeof(*scratch.depth));
  const std::size_t tiles = std::size_t{pane.tile_columns} * tiles_down;
  __builtin_memset(scratch.tile_depth, 0, tiles * sizeof(*scratch.tile_depth));
  __builtin_memset(scratch.tile_changed, 0, sizeof(scratch.tile_changed[0]) * tiles_down);
  if (task.width % kTileEdge == 0 && task.height % kTileEdge == 0) return;
  for (std::uint32_t row = 0; row < pane.rows; row += kBlocks) {
    for (std::uint32_t column = 0; column < pane.columns; ++column) {
      const IntLanes x = spread(static_cast<std::int32_t>(column * kBlockWidth)) + pixelsRight();
      const IntLanes y = spread(static_cast<std::int32_t>(row * kBlockHeight)) + pixelsDown();
      const IntLanes outside = (x >= spread(static_cast<std::int32_t>(task.width))) |
                               (y >= spread(static_cast<std::int32_t>(task.height)));
      store(placeOf(pane, column, row).depth, as<IntLanes>(spread(__builtin_inff())) & outside);
    }
  }
}

/// Record 0: the background, a flat surface of its color.
void recordBackground(const Pane& pane) {
  float* record = recordAt(pane, 0);
  __builtin_memset(record, 0, sizeof(float) * kRecordStride);
  __builtin_memset(colorsAt(pane, 0), 0, sizeof(float) * kRecordStride);
  record[kTexels] = as<float>(pane.task->background);
  record[kKind] = as<float>(kFlatSurface);
}

/// Draws `count` small triangles, at most a vector of them. `corners` must have room for a whole
/// vector.
void drawGroup(Pane& pane, ClusterState& state, const std::int32_t* corners, std::uint32_t count) {
  if (pane.records + kLanes > kMostRecords) makeRoom(pane);
  SmallGroup group;
  GroupSetup setup;
  setUpGroup(*pane.task, state, load<IntLanes>(corners), group, setup);
  GroupSteps steps;
  setSteps(setup, steps);
  const std::uint32_t first = pane.records;
  unsigned seen = 0;
  const auto cover = [&](std::uint32_t n, const auto& test) {
    // No branch depends on whether a triangle is visible, because that is hard to predict.
    const bool shows = coverSmall(pane, setup, steps, n, test);
    seen |= static_cast<unsigned>(shows) << n;
    pane.records += static_cast<std::uint32_t>(shows);
  };
  GroupRecords records;
  if (state.facts.surface.least_alpha != 0) {
    makeRecords(state, group, records);
    for (std::uint32_t n = 0; n < count; ++n) {
      cover(n, alphaTest(pane, state, records.records[n], records.colors[n]));
    }
  } else {
    for (std::uint32_t n = 0; n < count; ++n) cover(n, Opaque{});
    if (seen != 0 && pane.shades) makeRecords(state, group, records);
  }
  if (seen != 0) markChanged(pane, setup, seen);
  if (seen != 0 && pane.shades) {
    keepRecords(pane, state, records, seen, first);
  } else {
    pane.records = first;
  }
}

void drawTriangles(Pane& pane, ClusterState& state, const Survivors& survivors) {
  for (std::uint32_t n = 0; n < survivors.small_count; n += kLanes) {
    const std::uint32_t left = survivors.small_count - n;
    drawGroup(pane, state, survivors.small + n, left < kLanes ? left : kLanes);
  }
  pane.counts.triangles_drawn += survivors.small_count;
  if (survivors.large_count != 0 && state.facts.isTextured()) {
    readCoordinates(state);
  }
  for (std::uint32_t n = 0; n < survivors.large_count; n += kLanes) {
    drawLargeGroup(pane, state, survivors.large + n, survivors.large_count - n);
  }
  for (std::uint32_t n = 0; n < survivors.clipped_count; ++n) {
    drawClipped(pane, state, survivors.clipped[n]);
  }
}

void drawCluster(Pane& pane, const SeenCluster& seen) {
  const PlacedModel& placed = pane.task->models[seen.model];
  const VertexFrame frame = vertexFrame(*pane.task, placed);
  ClusterState state;
  state.has_coordinates = false;
  state.facts = clusterFacts(placed, seen.cluster);
  state.frame = &frame;
  state.colors = clusterColors(state.facts);
  const float farthest = placeVertices(state);
  if (state.any_bad && pane.task->culling) markBeside(*pane.task, state);
  const bool compares = pane.task->culling && (state.any_bad || hidesSome(pane, seen, farthest));
  Survivors survivors;
  sortTriangles(pane, seen, state, compares, survivors);
  drawTriangles(pane, state, survivors);
  ++pane.counts.clusters_drawn;
}

PaneCounts drawPane(const PaneTask& task, const PaneScratch& scratch) noexcept {
  Pane pane = newPane(task, scratch);
  clearPane(pane);
  recordBackground(pane);
  const std::uint32_t count = findClusters(task, scratch, pane.counts);
  sortClusters(scratch, count);
  for (std::uint32_t n = 0; n < count; ++n) {
    const SeenCluster& seen = scratch.seen[scratch.order[n]];
    if (task.culling && isHidden(pane, seen)) continue;
    drawCluster(pane, seen);
  }
  resolve(pane);
  return pane.counts;
}

}  // namespace
}  // namespace galactic::render
