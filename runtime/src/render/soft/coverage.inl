// Which pixels triangles cover, and where they are in front of what was drawn before.
//
// Vertices lie on a lattice of 1/256 pixel, so edge functions are integers and exact: two triangles
// that share an edge get opposite numbers for it, and the rule of the upper left edge gives a pixel
// on the edge to one of them.
namespace galactic::render {
namespace {

/// A test of eight pixels besides coverage and depth: passes all.
struct Opaque {
  static constexpr bool kTests = false;
};

/// The pixels of a block.
inline PixelOffsets blockPixels() { return {pixelsRight(), pixelsDown()}; }

/// Where a block of a triangle's pixels comes to lie.
struct BlockPlace {
  float* depth;
  std::int32_t* ids;
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

/// A pane as triangles are drawn on it, block by block.
template <class Test>
struct PaneTarget {
  const PaneScratch* scratch;
  std::size_t stride;
  IntLanes id;
  const Test* test;
  BlockPlace place{};
  std::size_t row_start = 0;

  PaneTarget(const Pane& pane, const Test& also)
      : scratch(pane.scratch),
        stride(static_cast<std::size_t>(pane.columns) * kWidth),
        id(spread(static_cast<std::int32_t>(pane.records))),
        test(&also) {}

  void start(std::uint32_t column, std::uint32_t row) {
    row_start = row * stride + static_cast<std::size_t>(column) * kWidth;
    place = {scratch->depth + row_start, scratch->ids + row_start};
  }
  IntLanes cover(const EdgeLanes& edges, Lanes z) const {
    return coverBlock(place, edges, z, id, *test);
  }
  void right() {
    place.depth += kWidth;
    place.ids += kWidth;
  }
  void nextRow() {
    row_start += stride;
    place = {scratch->depth + row_start, scratch->ids + row_start};
  }
};

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

/// Least 1/w of a tile.
inline float tileDepth(const Pane& pane, std::uint32_t tile_x, std::uint32_t tile_y) {
  const PaneScratch& scratch = *pane.scratch;
  const std::size_t tile = static_cast<std::size_t>(tile_y) * pane.tile_columns + tile_x;
  if ((scratch.tile_changed[tile_y] >> tile_x & 1U) == 0) return scratch.tile_depth[tile];
  constexpr std::uint32_t kRows = kTileEdge / kBlockHeight;
  const std::size_t stride = static_cast<std::size_t>(pane.columns) * kWidth;
  const float* from = scratch.depth + tile_y * kRows * stride + std::size_t{2} * tile_x * kWidth;
  Lanes nearest = load<Lanes>(from);
  for (std::uint32_t row = 0; row < kRows; ++row, from += stride) {
    nearest = lesser(nearest, lesser(load<Lanes>(from), load<Lanes>(from + kWidth)));
  }
  scratch.tile_changed[tile_y] &= ~(1U << tile_x);
  scratch.tile_depth[tile] = least(nearest);
  return scratch.tile_depth[tile];
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
