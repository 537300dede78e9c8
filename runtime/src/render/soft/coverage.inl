// Which pixels triangles cover, and where they are in front of what was drawn before.
//
// Vertices lie on a lattice of 1/256 pixel, so edge functions are integers and exact: two triangles
// that share an edge get opposite numbers for it, and the rule of the upper left edge gives a pixel
// on the edge to one of them.
namespace galactic::render {
namespace {

/// A test of a vector of pixels besides coverage and depth: passes all.
struct Opaque {
  static constexpr bool kTests = false;
};

/// Which pixels of a vector were drawn, and 1/w of all of them now.
struct Covered {
  LaneSet shown;
  Lanes depth;
};

/// Draws a vector of pixels, but for those whose sign in `outside` is set.
template <class Test>
inline Covered coverBlocks(const BlockPlace& place, IntLanes outside, Lanes z, IntLanes id,
                           const Test& test) {
  const Lanes old = load<Lanes>(place.depth);
  LaneSet shown = insideAndGreater(outside, z, old);
  if constexpr (Test::kTests) {
    if (bitsOf(shown) == 0) return {shown, old};
    shown &= bySign(test(place, z));
  }
  const Lanes depth = pickFrom(shown, z, old);
  store(place.depth, depth);
  store(place.ids, pickFrom(shown, id, load<IntLanes>(place.ids)));
  return {shown, depth};
}

/// How an edge function changes from pixel to pixel within a vector: block after block.
inline IntLanes edgeOffsets(std::int32_t right, std::int32_t down) {
  return pixelsRight() * spread(right) + (-pixelsDown() & spread(down));
}

/// Draws triangle `n` of a group, row by row; says whether it shows.
template <class Test>
inline bool coverSmall(const Pane& pane, const GroupSetup& group, unsigned n, const Test& test) {
  const auto lanes = [&](int e) {
    return spread(group.edge[e][n]) + edgeOffsets(group.edge_right[e][n], group.edge_down[e][n]);
  };
  const auto right = [&](int e) {
    return spread(group.edge_right[e][n] * static_cast<std::int32_t>(kBlocks * kBlockWidth));
  };
  const auto down = [&](int e) { return spread(group.edge_down[e][n] * 2); };
  EdgeLanes row_edges{lanes(0), lanes(1), lanes(2)};
  const EdgeLanes beside{right(0), right(1), right(2)};
  const EdgeLanes below{down(0), down(1), down(2)};
  // From block to block, as all processors do: no lane may take a short cut.
  Lanes row_z = spread(group.z[n]) + toFloat(pixelsRight() & 3) * spread(group.z_right[n]) +
                toFloat(pixelsDown()) * spread(group.z_down[n]);
  const Lanes z_beside = spread(group.z_right[n] * 4);
  const Lanes z_below = spread(group.z_down[n] * 2);
  const Lanes z_low = spread(group.z_low[n]);
  const Lanes z_high = spread(group.z_high[n]);
  const IntLanes id = spread(static_cast<std::int32_t>(pane.records));
  const auto first_column = static_cast<std::uint32_t>(group.first_column[n]);
  const std::uint32_t first = first_column / kBlocks;
  const std::uint32_t more = static_cast<std::uint32_t>(group.last_column[n]) / kBlocks - first;
  LaneSet hit = noLanes();
  for (std::int32_t row = group.first_row[n]; row <= group.last_row[n]; ++row) {
    BlockPlace place = placeOf(pane, first * kBlocks, static_cast<std::uint32_t>(row));
    EdgeLanes edges = row_edges;
    Lanes z = firstBlocks(row_z, z_beside, first_column % kBlocks != 0);
    for (std::uint32_t left = more;; --left) {
      hit |= coverBlocks(place, edges.a | edges.b | edges.c, lesser(greater(z, z_low), z_high), id,
                         test)
                 .shown;
      if (left == 0) break;
      edges = {edges.a + beside.a, edges.b + beside.b, edges.c + beside.c};
      z = nextBlocks(z, z_beside);
      place = {place.depth + kLanes, place.ids + kLanes};
    }
    row_edges = {row_edges.a + below.a, row_edges.b + below.b, row_edges.c + below.c};
    row_z = row_z + z_below;
  }
  return bitsOf(hit) != 0;
}

/// Marks the tiles of triangle `n` where it shows.
inline void markChanged(const Pane& pane, const GroupSetup& group, unsigned n, bool shows) {
  const auto first_column = static_cast<unsigned>(group.first_column[n]) / 2;
  const auto last_column = static_cast<unsigned>(group.last_column[n]) / 2;
  const std::uint32_t columns = (2U << last_column) - (1U << first_column);
  const std::uint32_t marks = shows ? columns : 0;
  std::uint32_t* changed = pane.scratch->tile_changed;
  const std::int32_t first = group.first_row[n] / 4;
  const std::int32_t last = group.last_row[n] / 4;
  changed[first] |= marks;
  changed[last] |= marks;
  for (std::int32_t y = first + 1; y < last; ++y) changed[y] |= marks;
}

/// Notes the least 1/w of a tile.
inline void noteDepth(const Pane& pane, std::uint32_t tile_x, std::uint32_t tile_y, float depth) {
  const PaneScratch& scratch = *pane.scratch;
  scratch.tile_depth[std::size_t{tile_y} * pane.tile_columns + tile_x] = depth;
  scratch.tile_changed[tile_y] &= ~(1U << tile_x);
}

/// Least 1/w of a tile.
inline float tileDepth(const Pane& pane, std::uint32_t tile_x, std::uint32_t tile_y) {
  const PaneScratch& scratch = *pane.scratch;
  const std::size_t tile = static_cast<std::size_t>(tile_y) * pane.tile_columns + tile_x;
  if ((scratch.tile_changed[tile_y] >> tile_x & 1U) == 0) return scratch.tile_depth[tile];
  constexpr std::uint32_t kRows = kTileEdge / kBlockHeight;
  const std::size_t stride = static_cast<std::size_t>(pane.columns) * kWidth;
  const float* from = scratch.depth + tile_y * kRows * stride + std::size_t{2} * tile_x * kWidth;
  Lanes farthest = load<Lanes>(from);
  for (std::uint32_t row = 0; row < kRows; ++row, from += stride) {
    for (std::uint32_t n = 0; n < 2 * kWidth; n += kLanes) {
      farthest = lesser(farthest, load<Lanes>(from + n));
    }
  }
  noteDepth(pane, tile_x, tile_y, least(farthest));
  return scratch.tile_depth[tile];
}

/// Of the tiles of a row from `x` on that are set in `bits`: those that do not hide all that is at
/// most as near as `nearest` tells for each.
inline unsigned mayShow(const Pane& pane, std::int32_t x, std::int32_t y, unsigned bits,
                        Lanes nearest) {
  const PaneScratch& scratch = *pane.scratch;
  const float* depth = scratch.tile_depth + static_cast<std::size_t>(y) * pane.tile_columns + x;
  // What is known of a tile is never too near, even where the tile has changed since.
  bits &= signBits(load<Lanes>(depth) < nearest);
  const unsigned changed = bits & scratch.tile_changed[y] >> static_cast<unsigned>(x);
  if (changed == 0) return bits;
  for (unsigned left = changed; left != 0; left &= left - 1) {
    tileDepth(pane, static_cast<std::uint32_t>(x + lowestBit(left)), static_cast<std::uint32_t>(y));
  }
  return bits & signBits(load<Lanes>(depth) < nearest);
}

/// Whether what was drawn hides all that lies in the cluster's tiles. Measures all of them where
/// they are few: triangles are compared with them, too.
inline bool isHidden(const Pane& pane, const SeenCluster& seen) {
  constexpr std::uint32_t kFew = 32;
  const std::uint32_t wide = seen.tiles[1] - seen.tiles[0] + 1U;
  const bool few = wide * (seen.tiles[3] - seen.tiles[2] + 1U) <= kFew;
  bool hidden = true;
  for (std::uint32_t y = seen.tiles[2]; y <= seen.tiles[3]; ++y) {
    for (std::uint32_t x = seen.tiles[0]; x <= seen.tiles[1]; ++x) {
      if (tileDepth(pane, x, y) >= seen.nearest) continue;
      if (!few) return false;
      hidden = false;
    }
  }
  return hidden;
}

}  // namespace
}  // namespace galactic::render
