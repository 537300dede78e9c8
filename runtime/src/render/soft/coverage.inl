// Finds the pixels that triangles cover, and where the triangles are in front of what was drawn
// before.
//
// Vertices lie on a lattice of 1/256 pixel, so edge functions are integers and exact: two triangles
// that share an edge get opposite numbers for it, and the top-left rule gives a pixel on the edge
// to exactly one of them.
namespace galactic::render {
namespace {

/// A test of a vector of pixels besides coverage and depth; this one passes all pixels.
struct Opaque {
  static constexpr bool kTests = false;
};

/// Which pixels of a vector were drawn, and 1/w of all its pixels afterwards.
struct Covered {
  LaneSet shown;
  Lanes depth;
};

/// Draws the pixels of a vector whose sign in `outside` is not set.
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
  storeFrom(shown, place.ids, id);
  return {shown, depth};
}

/// The changes of an edge function from the first pixel of a vector to its pixels.
inline IntLanes edgeOffsets(std::int32_t right, std::int32_t down) {
  return pixelsRight() * spread(right) + pixelsDown() * spread(down);
}

/// How the values of a GroupSetup change from one vector to those beside and below it.
struct alignas(kGroupAlignment) GroupSteps {
  std::int32_t edge_beside[3][kLanes], edge_below[3][kLanes];
  float z_beside[kLanes], z_below[kLanes];
};

inline void setSteps(const GroupSetup& group, GroupSteps& steps) {
  constexpr auto kWide = static_cast<std::int32_t>(kBlockWidth);
  constexpr auto kRows = static_cast<std::int32_t>(kHigh);
  for (int e = 0; e < 3; ++e) {
    store(steps.edge_beside[e], load<IntLanes>(group.edge_right[e]) * kWide);
    store(steps.edge_below[e], load<IntLanes>(group.edge_down[e]) * kRows);
  }
  store(steps.z_beside, load<Lanes>(group.z_right) * spread(4.0F));
  store(steps.z_below, load<Lanes>(group.z_down) * spread(2.0F));
}

/// Triangle `n` of a group while it is drawn on the pane, row by row.
template <class Test>
struct SmallCover {
  const Pane& pane;
  const GroupSetup& group;
  const GroupSteps& steps;
  unsigned n;
  const Test& test;

  EdgeLanes edges{lanes(0), lanes(1), lanes(2)};
  // 1/w is summed up from block to block, whatever the width of vectors, so that all processors
  // round alike.
  Lanes z = firstBlocks(spread(group.z[n]) + toFloat(pixelsRight()) * spread(group.z_right[n]) +
                            toFloat(pixelsDown() & 1) * spread(group.z_down[n]),
                        spread(steps.z_below[n]), group.first_row[n]);
  IntLanes id = idOf(pane.records);
  LaneSet hit = noLanes();

  IntLanes lanes(int e) const {
    return spread(group.edge[e][n]) + edgeOffsets(group.edge_right[e][n], group.edge_down[e][n]);
  }
  void cover(const BlockPlace& place, const EdgeLanes& at, Lanes z_there) {
    const Lanes within = lesser(greater(z_there, spread(group.z_low[n])), spread(group.z_high[n]));
    hit = eitherOf(hit, coverBlocks(place, at.a | at.b | at.c, within, id, test).shown);
  }
  void nextRow() {
    edges = {edges.a + spread(steps.edge_below[0][n]), edges.b + spread(steps.edge_below[1][n]),
             edges.c + spread(steps.edge_below[2][n])};
    z = nextBlocks(z, spread(steps.z_below[n]));
  }
  void coverTwo(const BlockPlace& place) {
    cover(place, edges, z);
    const EdgeLanes beside{edges.a + spread(steps.edge_beside[0][n]),
                           edges.b + spread(steps.edge_beside[1][n]),
                           edges.c + spread(steps.edge_beside[2][n])};
    cover({place.depth + kLanes, place.ids + kLanes}, beside, z + spread(steps.z_beside[n]));
  }
  /// `more`: how many vectors follow the first one in the row.
  void coverRow(BlockPlace place, Lanes z_there, std::uint32_t more) {
    EdgeLanes at = edges;
    for (;; --more) {
      cover(place, at, z_there);
      if (more == 0) return;
      at = {at.a + spread(steps.edge_beside[0][n]), at.b + spread(steps.edge_beside[1][n]),
            at.c + spread(steps.edge_beside[2][n])};
      z_there = z_there + spread(steps.z_beside[n]);
      place = {place.depth + kLanes, place.ids + kLanes};
    }
  }
};

/// Draws triangle `n` of a group; returns whether any of it is visible.
template <class Test>
inline bool coverSmall(const Pane& pane, const GroupSetup& group, const GroupSteps& steps,
                       unsigned n, const Test& test) {
  SmallCover<Test> small{pane, group, steps, n, test};
  const auto column = static_cast<std::uint32_t>(group.first_column[n]);
  const std::uint32_t more = static_cast<std::uint32_t>(group.last_column[n]) - column;
  const auto row = static_cast<std::uint32_t>(group.first_row[n]);
  const std::size_t stride = rowStride(pane);
  BlockPlace place = placeOf(pane, column, row);
  std::uint32_t left = static_cast<std::uint32_t>(group.last_row[n]) / kBlocks - row / kBlocks;
  const auto rows = [&](const auto& cover_row) {
    for (;; --left) {
      cover_row();
      if (left == 0) return bitsOf(small.hit) != 0;
      small.nextRow();
      place = {place.depth + stride, place.ids + stride};
    }
  };
  // Most triangles are narrow, and their rows need no inner loop.
  if (more == 0) return rows([&] { small.cover(place, small.edges, small.z); });
  if (more == 1) return rows([&] { small.coverTwo(place); });
  return rows([&] { small.coverRow(place, small.z, more); });
}

/// Marks the tiles of the triangles whose bits are set as changed, in one box around all of them.
inline void markChanged(const Pane& pane, const GroupSetup& group, unsigned seen) {
  const LaneSet shown = setOf(seen);
  const auto first = [&](const std::int32_t* of_group) {
    return least(pickFrom(shown, load<IntLanes>(of_group), spread(INT32_MAX)));
  };
  const auto last = [&](const std::int32_t* of_group) {
    return most(pickFrom(shown, load<IntLanes>(of_group), spread(0)));
  };
  const std::uint32_t marks = (2U << (static_cast<unsigned>(last(group.last_column)) / 2)) -
                              (1U << (static_cast<unsigned>(first(group.first_column)) / 2));
  const std::int32_t bottom = last(group.last_row) / 4;
  for (std::int32_t y = first(group.first_row) / 4; y <= bottom; ++y) {
    pane.scratch->tile_changed[y] |= marks;
  }
}

/// Stores the least 1/w of a tile, which is then up to date.
inline void noteDepth(const Pane& pane, std::uint32_t tile_x, std::uint32_t tile_y, float depth) {
  const PaneScratch& scratch = *pane.scratch;
  scratch.tile_depth[std::size_t{tile_y} * pane.tile_columns + tile_x] = depth;
  scratch.tile_changed[tile_y] &= ~(1U << tile_x);
}

/// The least 1/w of a tile; measures the tile if it has changed.
inline float tileDepth(const Pane& pane, std::uint32_t tile_x, std::uint32_t tile_y) {
  const PaneScratch& scratch = *pane.scratch;
  const std::size_t tile = static_cast<std::size_t>(tile_y) * pane.tile_columns + tile_x;
  if ((scratch.tile_changed[tile_y] >> tile_x & 1U) == 0) return scratch.tile_depth[tile];
  constexpr std::uint32_t kRows = kTileEdge / kHigh;
  const std::size_t stride = rowStride(pane);
  const float* from =
      scratch.depth + std::size_t{tile_y} * kRows * stride + std::size_t{2} * tile_x * kLanes;
  Lanes farthest = load<Lanes>(from);
  for (std::uint32_t row = 0; row < kRows; ++row, from += stride) {
    for (std::uint32_t n = 0; n < 2 * kLanes; n += kLanes) {
      farthest = lesser(farthest, load<Lanes>(from + n));
    }
  }
  noteDepth(pane, tile_x, tile_y, least(farthest));
  return scratch.tile_depth[tile];
}

/// Of the tiles of a row from `x` on whose bits are set: those that do not hide everything that is
/// at most as near as their lane of `nearest`.
inline unsigned mayShow(const Pane& pane, std::int32_t x, std::int32_t y, unsigned bits,
                        Lanes nearest) {
  const PaneScratch& scratch = *pane.scratch;
  const float* depth = scratch.tile_depth + static_cast<std::size_t>(y) * pane.tile_columns + x;
  // A stored depth is a lower bound even if the tile has changed since, because 1/w only grows.
  bits &= bitsOf(whereLess(load<Lanes>(depth), nearest));
  const unsigned changed = bits & scratch.tile_changed[y] >> static_cast<unsigned>(x);
  if (changed == 0) return bits;
  for (unsigned left = changed; left != 0; left &= left - 1) {
    tileDepth(pane, static_cast<std::uint32_t>(x + lowestBit(left)), static_cast<std::uint32_t>(y));
  }
  return bits & bitsOf(whereLess(load<Lanes>(depth), nearest));
}

/// Size of a "square" of tiles that are tested together: one tile per lane, in rows of four.
constexpr std::int32_t kSquareWidth = 4;
constexpr auto kSquareHeight = static_cast<std::int32_t>(kLanes) / kSquareWidth;

/// Like mayShow(), for a square of tiles that begins at `x`, `y`.
inline unsigned mayShowInSquare(const Pane& pane, std::int32_t x, std::int32_t y, unsigned bits,
                                Lanes nearest) {
  const PaneScratch& scratch = *pane.scratch;
  const float* depth = scratch.tile_depth + static_cast<std::size_t>(y) * pane.tile_columns + x;
  bits &= bitsOf(whereLess(loadSquare(depth, pane.tile_columns), nearest));
  unsigned changed = 0;
  for (std::int32_t row = 0; row < kSquareHeight; ++row) {
    const unsigned of_row = scratch.tile_changed[y + row] >> static_cast<unsigned>(x) & 0xFU;
    changed |= of_row << static_cast<unsigned>(kSquareWidth * row);
  }
  changed &= bits;
  if (changed == 0) return bits;
  for (; changed != 0; changed &= changed - 1) {
    const int n = lowestBit(changed);
    tileDepth(pane, static_cast<std::uint32_t>(x + n % kSquareWidth),
              static_cast<std::uint32_t>(y + n / kSquareWidth));
  }
  return bits & bitsOf(whereLess(loadSquare(depth, pane.tile_columns), nearest));
}

/// Whether at least one of the cluster's tiles hides something that is as far as `farthest`.
inline bool hidesSome(const Pane& pane, const SeenCluster& seen, float farthest) {
  unsigned open = kAllLanes;
  for (std::uint32_t y = seen.tiles[2]; y <= seen.tiles[3]; ++y) {
    const float* row = pane.scratch->tile_depth + std::size_t{y} * pane.tile_columns;
    for (std::uint32_t x = seen.tiles[0]; x <= seen.tiles[1]; x += kLanes) {
      open &= bitsOf(whereLess(load<Lanes>(row + x), spread(farthest))) |
              ~firstLanes(seen.tiles[1] - x + 1U);
    }
  }
  return open != kAllLanes;
}

/// Whether what was drawn hides everything in the cluster's tiles. If the tiles are few, this
/// measures all of them, since triangles are compared with them too.
inline bool isHidden(const Pane& pane, const SeenCluster& seen) {
  constexpr std::uint32_t kFew = 32;
  const std::uint32_t wide = seen.tiles[1] - seen.tiles[0] + 1U;
  const bool few = wide * (seen.tiles[3] - seen.tiles[2] + 1U) <= kFew;
  bool hidden = true;
  for (std::int32_t y = seen.tiles[2]; y <= seen.tiles[3]; ++y) {
    for (std::int32_t x = seen.tiles[0]; x <= seen.tiles[1];
         x += static_cast<std::int32_t>(kLanes)) {
      const unsigned within = firstLanes(static_cast<std::uint32_t>(seen.tiles[1] - x) + 1);
      if (mayShow(pane, x, y, within, spread(seen.nearest)) == 0) continue;
      if (!few) return false;
      hidden = false;
    }
  }
  return hidden;
}

}  // namespace
}  // namespace galactic::render
