// Which pixels triangles cover, and where they are in front of what was drawn before.
//
// Vertices lie on a lattice of 1/256 pixel, so edge functions are integers and exact: two triangles
// that share an edge get opposite numbers for it, and the rule of the upper left edge gives a pixel
// on the edge to one of them.
namespace galactic::render {
namespace {

/// A pane while it is drawn.
struct Pane {
  const PaneTask* task;
  const PaneScratch* scratch;
  /// In blocks and in tiles, whole.
  std::uint32_t columns, rows, tile_columns;
  /// In use.
  std::uint32_t records;
  PaneCounts counts;
  bool shades;
};

/// Offsets of the pixels of a block.
inline IntLanes laneRight() { return IntLanes{0, 1, 2, 3, 0, 1, 2, 3}; }
inline IntLanes laneDown() { return IntLanes{0, 0, 0, 0, 1, 1, 1, 1}; }

/// Eight triangles ready to be drawn. Starts are at the center of the first pixel of the first
/// block; edge functions are not negative inside; "right" and "down": changes per pixel.
struct alignas(64) GroupSetup {
  std::int32_t edge[3][kWidth], edge_right[3][kWidth], edge_down[3][kWidth];
  float z[kWidth], z_right[kWidth], z_down[kWidth];
  /// Of 1/w at the corners: no pixel leaves this range, however thin the triangle.
  float z_low[kWidth], z_high[kWidth];
  /// First and last, in blocks.
  std::int32_t first_column[kWidth], last_column[kWidth], first_row[kWidth], last_row[kWidth];
};

/// A test of eight pixels besides coverage and depth: passes all.
struct Opaque {
  static constexpr bool kTests = false;
};

/// Where a block of a triangle's pixels comes to lie.
struct BlockPlace {
  float* depth;
  std::int32_t* ids;
};

/// Eight values that change linearly over the pane.
struct EdgeLanes {
  IntLanes a, b, c;
};

/// Draws eight pixels; the sign bits of the result tell which.
template <class Test>
inline IntLanes coverBlock(const BlockPlace& place, const EdgeLanes& edges, Lanes z, IntLanes id,
                           const Test& test) {
  const Lanes old = load<Lanes>(place.depth);
  IntLanes shown = ~(edges.a | edges.b | edges.c) & (z > old);
  if constexpr (Test::kTests) {
    if (signBits(shown) == 0) return shown;
    shown &= test(place, z);
  }
  store(place.depth, pickBySign(shown, z, old));
  store(place.ids, pickBySign(shown, id, load<IntLanes>(place.ids)));
  return shown;
}

inline void markChanged(const Pane& pane, const GroupSetup& group, unsigned n) {
  const std::int32_t first_column = group.first_column[n] / 2;
  const std::int32_t last_column = group.last_column[n] / 2;
  for (std::int32_t y = group.first_row[n] / 4; y <= group.last_row[n] / 4; ++y) {
    std::uint8_t* row =
        pane.scratch->tile_changed + static_cast<std::size_t>(y) * pane.tile_columns;
    for (std::int32_t x = first_column; x <= last_column; ++x) row[x] = 1;
  }
}

/// Draws triangle `n` of a group; says whether it is seen.
template <class Test>
bool coverTriangle(const Pane& pane, const GroupSetup& group, unsigned n, std::int32_t id_value,
                   const Test& test) {
  const IntLanes right = laneRight();
  const IntLanes lower = -laneDown();
  const auto edge_lanes = [&](int e) {
    return spread(group.edge[e][n]) + right * spread(group.edge_right[e][n]) +
           (lower & spread(group.edge_down[e][n]));
  };
  EdgeLanes row_edges{edge_lanes(0), edge_lanes(1), edge_lanes(2)};
  const auto four_right = [&](int e) { return spread(group.edge_right[e][n] * 4); };
  const auto two_down = [&](int e) { return spread(group.edge_down[e][n] * 2); };
  const EdgeLanes next{four_right(0), four_right(1), four_right(2)};
  const EdgeLanes below{two_down(0), two_down(1), two_down(2)};
  Lanes row_z = spread(group.z[n]) + toFloat(right) * spread(group.z_right[n]) +
                toFloat(laneDown()) * spread(group.z_down[n]);
  const Lanes z_next = spread(group.z_right[n] * 4);
  const Lanes z_below = spread(group.z_down[n] * 2);
  const Lanes z_low = spread(group.z_low[n]);
  const Lanes z_high = spread(group.z_high[n]);
  const IntLanes id = spread(id_value);
  IntLanes hit = spread(0);
  const std::size_t stride = static_cast<std::size_t>(pane.columns) * kWidth;
  std::size_t at = static_cast<std::size_t>(group.first_row[n]) * stride +
                   static_cast<std::size_t>(group.first_column[n]) * kWidth;
  const auto columns = static_cast<std::uint32_t>(group.last_column[n] - group.first_column[n]);
  for (std::int32_t row = group.first_row[n]; row <= group.last_row[n]; ++row, at += stride) {
    EdgeLanes edges = row_edges;
    Lanes z = row_z;
    BlockPlace place{pane.scratch->depth + at, pane.scratch->ids + at};
    for (std::uint32_t column = 0;; ++column) {
      hit |= coverBlock(place, edges, lesser(greater(z, z_low), z_high), id, test);
      if (column == columns) break;
      edges = {edges.a + next.a, edges.b + next.b, edges.c + next.c};
      z = z + z_next;
      place.depth += kWidth;
      place.ids += kWidth;
    }
    row_edges = {row_edges.a + below.a, row_edges.b + below.b, row_edges.c + below.c};
    row_z = row_z + z_below;
  }
  if (signBits(hit) == 0) return false;
  markChanged(pane, group, n);
  return true;
}

/// Least 1/w of a tile.
inline float tileDepth(const Pane& pane, std::uint32_t tile_x, std::uint32_t tile_y) {
  const PaneScratch& scratch = *pane.scratch;
  const std::size_t tile = static_cast<std::size_t>(tile_y) * pane.tile_columns + tile_x;
  if (scratch.tile_changed[tile] == 0) return scratch.tile_depth[tile];
  constexpr std::uint32_t kRows = kTileEdge / kBlockHeight;
  const std::size_t stride = static_cast<std::size_t>(pane.columns) * kWidth;
  const float* from = scratch.depth + tile_y * kRows * stride + std::size_t{2} * tile_x * kWidth;
  Lanes nearest = load<Lanes>(from);
  for (std::uint32_t row = 0; row < kRows; ++row, from += stride) {
    nearest = lesser(nearest, lesser(load<Lanes>(from), load<Lanes>(from + kWidth)));
  }
  scratch.tile_changed[tile] = 0;
  scratch.tile_depth[tile] = least(nearest);
  return scratch.tile_depth[tile];
}

/// Whether what was drawn hides all that lies in the cluster's tiles.
inline bool isHidden(const Pane& pane, const SeenCluster& seen) {
  for (std::uint32_t y = seen.tiles[2]; y <= seen.tiles[3]; ++y) {
    for (std::uint32_t x = seen.tiles[0]; x <= seen.tiles[1]; ++x) {
      if (tileDepth(pane, x, y) < seen.nearest) return false;
    }
  }
  return true;
}

}  // namespace
}  // namespace galactic::render
