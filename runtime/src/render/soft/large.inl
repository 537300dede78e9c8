// Draws triangles one by one: large ones, and the remains of clipped ones.
namespace galactic::render {
namespace {

/// Changes that are the same in all tiles of a large triangle.
struct TileSteps {
  /// Changes of edge functions from one vector to the ones beside and below it.
  IntLanes edge_beside[3], edge_below[3];
  Lanes z_beside;
  /// For each row of vectors: the changes of 1/w from the first row of blocks to the vectors' own.
  Lanes z_down[kTileEdge / kHigh];
};

inline TileSteps tileSteps(const LargeSetup& setup) {
  TileSteps steps;
  for (int n = 0; n < 3; ++n) {
    steps.edge_beside[n] = spread(setup.edges[n].right * static_cast<std::int32_t>(kBlockWidth));
    steps.edge_below[n] = spread(setup.edges[n].down * static_cast<std::int32_t>(kHigh));
  }
  steps.z_beside = spread(static_cast<float>(setup.depth.right * 4));
  const auto down = [&](std::uint32_t row) {
    return static_cast<float>(setup.depth.down * (kBlockHeight * row));
  };
  for (std::uint32_t row = 0; row < kTileEdge / kHigh; ++row) {
    steps.z_down[row] = ofBlocks(down(row * kBlocks), down(row * kBlocks + 1));
  }
  return steps;
}

/// Edge functions and 1/w at the first pixels of some tiles, and where the tiles lie: among the
/// pane's pixels and among its tiles.
struct TileStarts {
  alignas(kVectorBytes) std::int32_t pixels[kHalf];
  alignas(kVectorBytes) std::int32_t tiles[kHalf];
  alignas(kVectorBytes) std::int32_t edges[3][kHalf];
  alignas(kVectorBytes) float z[kHalf];
};

constexpr int kLogMostTiles = 5;
static_assert(1U << kLogMostTiles == kMostTiles);

/// `tiles`: numbers of tiles as in TileList.
inline void startTiles(const Pane& pane, const LargeSetup& setup, HalfInts tiles,
                       TileStarts& starts) {
  // Beyond this, the sign is the same in the whole tile, since changes per pixel are below 2^24.
  constexpr double kMost = 1 << 30;
  constexpr double kEdge = kTileEdge;
  const HalfInts x = tiles & (kMostTiles - 1);
  // Masked, because the numbers after the last tile of a list are arbitrary.
  const HalfInts y = tiles >> kLogMostTiles & (kMostTiles - 1);
  const auto row = static_cast<std::int32_t>(rowStride(pane) * (kTileEdge / kHigh));
  store(starts.pixels, y * row + x * static_cast<std::int32_t>(kLanes * (kTileEdge / kBlockWidth)));
  store(starts.tiles, y * static_cast<std::int32_t>(pane.tile_columns) + x);
  const Doubles right = __builtin_convertvector(x, Doubles) * kEdge;
  const Doubles down = __builtin_convertvector(y, Doubles) * kEdge;
  for (int n = 0; n < 3; ++n) {
    // Exact, since all of these are whole numbers below 2^53.
    const LongEdge& edge = setup.edges[n];
    const Doubles value =
        static_cast<double>(edge.start) +
        (static_cast<double>(edge.right) * right + static_cast<double>(edge.down) * down);
    store(starts.edges[n], __builtin_convertvector(clampTo(value, -kMost, kMost), HalfInts));
  }
  const Plane& depth = setup.depth;
  store(starts.z, __builtin_convertvector(depth.start + (depth.right * right + depth.down * down),
                                          HalfFloats));
}

/// Where the tiles of a pane lie. This is passed by value, so that the compiler knows that no store
/// changes it.
struct TilePlaces {
  BlockPlace first;
  float* depth;
  std::size_t stride;
};

inline TilePlaces tilePlaces(const Pane& pane) {
  return {placeOf(pane, 0, 0), pane.scratch->tile_depth, rowStride(pane)};
}

/// Draws the pixels of tile `n` of `starts` and measures its depth, which findTiles() had brought
/// up to date. Returns which lanes have drawn something.
template <class Test>
inline LaneSet coverTile(const TilePlaces places, const LargeSetup& setup, const TileSteps& steps,
                         const TileStarts& starts, std::uint32_t n, IntLanes id, const Test& test) {
  const Lanes z_start = spread(starts.z[n]) + setup.z_offsets;
  EdgeLanes edges{setup.edges[0].offsets + spread(starts.edges[0][n]),
                  setup.edges[1].offsets + spread(starts.edges[1][n]),
                  setup.edges[2].offsets + spread(starts.edges[2][n])};
  const std::int32_t pixel = starts.pixels[n];
  BlockPlace first{places.first.depth + pixel, places.first.ids + pixel};
  LaneSet hit = noLanes();
  Lanes farthest = spread(__builtin_inff());
#pragma GCC unroll 4
  for (std::uint32_t row = 0; row < kTileEdge / kHigh; ++row) {
    BlockPlace place = first;
    Lanes z = z_start + steps.z_down[row];
    EdgeLanes at = edges;
#pragma GCC unroll 2
    for (std::uint32_t column = 0; column < kTileEdge / kBlockWidth; ++column) {
      const Covered covered = coverBlocks(place, at.a | at.b | at.c,
                                          lesser(greater(z, setup.z_low), setup.z_high), id, test);
      hit = eitherOf(hit, covered.shown);
      farthest = lesser(farthest, covered.depth);
      z = z + steps.z_beside;
      at = {at.a + steps.edge_beside[0], at.b + steps.edge_beside[1], at.c + steps.edge_beside[2]};
      place = {place.depth + kLanes, place.ids + kLanes};
    }
    edges = {edges.a + steps.edge_below[0], edges.b + steps.edge_below[1],
             edges.c + steps.edge_below[2]};
    first = {first.depth + places.stride, first.ids + places.stride};
  }
  places.depth[starts.tiles[n]] = least(farthest);
  return hit;
}

/// A linear function over a square of tiles (see mayShowInSquare()), enlarged by a bound of the
/// rounding errors, so that no lane is less than the exact value.
struct TileFunction {
  Lanes value, beside, below;
};

/// The edge functions of a large triangle, each at the pixel of a tile where it is largest, and 1/w
/// at the tile's nearest pixel.
struct TileFunctions {
  TileFunction a, b, c, nearest;

  IntLanes outside() const {
    return as<IntLanes>(a.value) | as<IntLanes>(b.value) | as<IntLanes>(c.value);
  }
  /// Moves to the next square.
  void move(Lanes TileFunction::*step) {
    a.value = a.value + a.*step;
    b.value = b.value + b.*step;
    c.value = c.value + c.*step;
    nearest.value = nearest.value + nearest.*step;
  }
};

/// The functions of the square whose first tile is `x`, `y`.
inline TileFunctions tileFunctions(const LargeSetup& setup, std::int32_t x, std::int32_t y) {
  // Three edges and 1/w at the pane's first pixel, and their changes per pixel.
  using Four = double __attribute__((vector_size(32)));
  using FourFloats = float __attribute__((vector_size(16)));
  using FourInts = std::int64_t __attribute__((vector_size(32)));
  const LongEdge* edges = setup.edges;
  const Plane& depth = setup.depth;
  const Four right{static_cast<double>(edges[0].right), static_cast<double>(edges[1].right),
                   static_cast<double>(edges[2].right), depth.right};
  const Four down{static_cast<double>(edges[0].down), static_cast<double>(edges[1].down),
                  static_cast<double>(edges[2].down), depth.down};
  const Four start{static_cast<double>(edges[0].start), static_cast<double>(edges[1].start),
                   static_cast<double>(edges[2].start), depth.start};
  const auto magnitudes = [](Four v) { return as<Four>(as<FourInts>(v) & INT64_MAX); };
  // A bound of the rounding errors of kMostTiles additions, and of those in coverTile(), relative
  // to the size of what is added.
  constexpr double kSumsRounding = 6e-6;
  constexpr double kEdge = kTileEdge;
  constexpr double kLast = kTileEdge - 1;
  const Four right_size = magnitudes(right);
  const Four down_size = magnitudes(down);
  // The change from the first pixel of a tile to the pixel where each of the four is largest.
  const Four reach = ((right_size + right) + (down_size + down)) * (kLast / 2);
  const Four first = (start + reach) + (right * (kEdge * x) + down * (kEdge * y));
  const Four size = magnitudes(first) + (right_size + down_size) * double{kPaneEdge};
  const auto starts = __builtin_convertvector(first + size * kSumsRounding, FourFloats);
  const auto rights = __builtin_convertvector(right * kEdge, FourFloats);
  const auto downs = __builtin_convertvector(down * kEdge, FourFloats);
  const auto function = [&](int n) -> TileFunction {
    // The lanes form rows of four tiles, in the same way as rows of four pixels.
    return {spread(starts[n]) + toFloat(pixelsRight()) * spread(rights[n]) +
                toFloat(pixelsDown()) * spread(downs[n]),
            spread(rights[n]) * static_cast<float>(kSquareWidth),
            spread(downs[n]) * static_cast<float>(kSquareHeight)};
  };
  return {function(0), function(1), function(2), function(3)};
}

/// A list of tiles of a pane, each as y * kMostTiles + x.
struct TileList {
  std::int32_t tiles[kMostTiles * kMostTiles + kLanes];
  std::uint32_t count = 0;
};

/// The tiles in the first `wide` columns and `high` rows of a square: bit n for lane n.
inline unsigned firstOfSquare(std::int32_t wide, std::int32_t high) {
  const unsigned row = (1U << static_cast<unsigned>(lesserOf(wide, kSquareWidth))) - 1;
  const auto rows = static_cast<unsigned>(kSquareWidth * lesserOf(high, kSquareHeight));
  return row * 0x1111U & ((1U << rows) - 1);
}

/// Lists the tiles that a large triangle touches and in which it may be visible. No branch depends
/// on which ones do, because that is hard to predict.
inline void findTiles(const Pane& pane, const LargeSetup& setup, const TileBox& box,
                      TileList& list) {
  const IntLanes numbers =
      pixelsRight() + pixelsDown() * spread(static_cast<std::int32_t>(kMostTiles));
  TileFunctions top = tileFunctions(setup, box.left, box.top);
  for (std::int32_t x = box.left; x <= box.right;
       x += kSquareWidth, top.move(&TileFunction::beside)) {
    TileFunctions functions = top;
    for (std::int32_t y = box.top; y <= box.bottom;
         y += kSquareHeight, functions.move(&TileFunction::below)) {
      const unsigned within = firstOfSquare(box.right - x + 1, box.bottom - y + 1);
      const unsigned touched = ~signBits(functions.outside()) & within;
      const unsigned bits =
          mayShowInSquare(pane, x, y, touched, lesser(functions.nearest.value, setup.z_high));
      const std::int32_t first = y * static_cast<std::int32_t>(kMostTiles) + x;
      storePicked(list.tiles + list.count, spread(first) + numbers, bits);
      list.count += static_cast<std::uint32_t>(__builtin_popcount(bits));
    }
  }
}

template <class Test>
bool coverTiles(const Pane& pane, const LargeSetup& setup, const TileBox& box, const Test& test) {
  TileList list;
  findTiles(pane, setup, box, list);
  if (list.count == 0) return false;
  const TileSteps steps = tileSteps(setup);
  const TilePlaces places = tilePlaces(pane);
  const IntLanes id = idOf(pane.records);
  LaneSet hit = noLanes();
  for (std::uint32_t first = 0; first < list.count; first += kHalf) {
    TileStarts starts;
    startTiles(pane, setup, load<HalfInts>(list.tiles + first), starts);
    const std::uint32_t count = list.count - first < kHalf ? list.count - first : kHalf;
    for (std::uint32_t n = 0; n < count; ++n) {
      hit = eitherOf(hit, coverTile(places, setup, steps, starts, n, id, test));
    }
  }
  return bitsOf(hit) != 0;
}

/// Sets the offsets, which depend on the pixels of a vector.
inline void setOffsets(LargeSetup& setup) {
  for (LongEdge& edge : setup.edges) edge.offsets = edgeOffsets(edge.right, edge.down);
  setup.z_offsets = toFloat(pixelsRight()) * spread(static_cast<float>(setup.depth.right)) +
                    toFloat(pixelsDown() & 1) * spread(static_cast<float>(setup.depth.down));
}

/// Draws a triangle that may touch `tiles`. `make_record` writes its record and that of its colors.
template <class MakeRecord>
inline void drawInTiles(Pane& pane, const ClusterState& state, LargeSetup& setup,
                        const TileBox& tiles, const MakeRecord& make_record) {
  ++pane.counts.triangles_drawn;
  setOffsets(setup);
  if (pane.records == kMostRecords) makeRoom(pane);
  float* record = recordAt(pane, pane.records);
  float* colors = colorsAt(pane, pane.records);
  bool seen = false;
  if (state.facts.surface.least_alpha != 0) {
    make_record(record, colors);
    seen = coverTiles(pane, setup, tiles, alphaTest(pane, state, record, colors));
  } else {
    seen = coverTiles(pane, setup, tiles, Opaque{});
    if (seen && pane.shades) make_record(record, colors);
  }
  if (seen && pane.shades) ++pane.records;
}

/// Draws one triangle of any size. Its corners go clockwise on the screen if it shows its face.
void drawLarge(Pane& pane, const ClusterState& state, const Corner& a, const Corner& b,
               const Corner& c) {
  LargeTriangle triangle;
  if (!faces(a, b, c, state.facts.cluster->two_sided != 0, triangle)) return;
  const TileBox tiles = tilesOf(*pane.task, triangle);
  if (tiles.right < tiles.left) return;
  LargeSetup setup = setUpLarge(triangle);
  drawInTiles(pane, state, setup, tiles, [&](float* record, float* colors) {
    recordLarge(state, triangle, setup.depth, record, colors);
  });
}

/// Draws `count` large triangles, but at most a vector of them. `corners` must have room for a
/// whole vector.
void drawLargeGroup(Pane& pane, const ClusterState& state, const std::int32_t* corners,
                    std::uint32_t count) {
  LargeGroup group;
  unsigned left = setUpLargeGroup(*pane.task, state, load<IntLanes>(corners), group);
  for (left &= firstLanes(count); left != 0; left &= left - 1) {
    const auto n = static_cast<std::uint32_t>(lowestBit(left));
    LargeSetup setup = setupOf(group, n);
    drawInTiles(pane, state, setup, tilesOf(group, n), [&](float* record, float* colors) {
      const auto packed = static_cast<std::uint32_t>(group.corners[n]);
      const Corner of_triangle[3] = {cornerOf(state, packed & 0xFFU),
                                     cornerOf(state, (packed >> 8U) & 0xFFU),
                                     cornerOf(state, (packed >> 16U) & 0xFFU)};
      const LargeTriangle triangle{{of_triangle, of_triangle + 1, of_triangle + 2}, group.area[n]};
      recordLarge(state, triangle, setup.depth, record, colors);
    });
  }
}

/// Clips a triangle, given by the numbers of its vertices, and draws what is left of it.
void drawClipped(Pane& pane, ClusterState& state, std::int32_t packed_corners) {
  if (state.facts.isTextured()) readCoordinates(state);
  const auto corners = static_cast<std::uint32_t>(packed_corners);
  Corner ready[kMostCorners];
  const int count = clipTriangle(state, corners & 0xFFU, (corners >> 8U) & 0xFFU,
                                 (corners >> 16U) & 0xFFU, ready);
  for (int n = 1; n + 1 < count; ++n) drawLarge(pane, state, ready[0], ready[n], ready[n + 1]);
}

}  // namespace
}  // namespace galactic::render
