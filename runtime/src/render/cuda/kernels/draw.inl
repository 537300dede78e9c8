// Draws clusters on the pixels of their panes. Each block draws one cluster after the other.
namespace galactic::render::cuda {
namespace {

/// What is visible at a pixel, as a number that is larger for what is nearer: 1/w in the upper
/// half, and in the lower half the complement of the cluster's rank and the piece, so that of
/// equally near ones the first in the order of drawing is larger. 0 if nothing is visible.
GALACTIC_EVERYWHERE inline std::uint64_t seenAt(float z, std::uint32_t rank, std::uint32_t piece) {
  const std::uint32_t order = rank << kPieceBits | piece;
  return static_cast<std::uint64_t>(as<std::uint32_t>(z)) << 32U | ~order;
}
GALACTIC_EVERYWHERE inline float depthOfSeen(std::uint64_t seen) {
  return as<float>(static_cast<std::uint32_t>(seen >> 32U));
}

/// Pieces of a cluster are numbered in the order in which the `soft` renderer draws them.
constexpr std::uint32_t kFirstLarge = kMostInCluster;
constexpr std::uint32_t kFirstCut = 2 * kMostInCluster;
/// Most triangles of a fan.
constexpr std::uint32_t kMostInFan = kMostCorners - 2;

/// First and last pixels that a small triangle can cover. A pane has at most 256 in a row.
struct PixelBox {
  std::uint8_t left, right, top, bottom;
};

/// A large triangle, or a part of a clipped one, that all threads draw together.
struct LargePiece {
  LargeSetup setup;
  TileBox tiles;
  std::uint32_t piece;
};
/// Most pieces that are drawn between two barriers.
constexpr std::uint32_t kMostPieces = 48;
constexpr std::uint32_t kMostCutTogether = kMostPieces / kMostInFan;

struct DrawShared {
  ClusterState state;
  VertexFrame frame;
  /// Totals of all clusters that the block drew.
  std::uint64_t clusters_drawn, triangles_drawn;
  std::uint32_t shown;
  std::uint32_t small_count, shared_count, large_count, cut_count, piece_count;
  std::uint8_t small[kMostInCluster];
  /// The small triangles that several threads share, by their places in `small`.
  std::uint8_t shared_small[kMostInCluster];
  std::uint8_t large[kMostInCluster];
  std::uint8_t cut[kMostInCluster];
  /// By their places in `small`.
  PixelBox boxes[kMostInCluster];
  union {
    GroupSetup setups[kMostInCluster];
    /// Used after the small triangles have been drawn.
    LargePiece pieces[kMostPieces];
  };
};

/// A pane, and the cluster that is drawn on it.
struct DrawPlace {
  const PaneTask* task;
  const SeenCluster* seen;
  std::uint64_t* pixels;
  const float* tile_depth;
  std::uint32_t tile_columns;
  std::uint32_t rank;
};

GALACTIC_EVERYWHERE inline DrawPlace drawPlace(const ViewSlice& slice, const WorkItem& item) {
  const PaneLists lists = paneLists(slice, item.pane);
  return {lists.task,
          lists.seen + lists.order[item.rank],
          slice.pixels + static_cast<std::size_t>(item.pane) * slice.pixels_of_pane,
          slice.tile_depth + static_cast<std::size_t>(item.pane) * slice.tiles_of_pane,
          (lists.task->width + kTileEdge - 1) / kTileEdge,
          item.rank};
}

/// If threads share a triangle, eight of them do, each of which draws one pixel of every block.
constexpr std::uint32_t kTeam = 8;

GALACTIC_EVERYWHERE inline PixelOffsets pixelOf(std::uint32_t lane) {
  return {static_cast<std::int32_t>(lane % kBlockWidth),
          static_cast<std::int32_t>(lane / kBlockWidth)};
}

struct AllPass {
  GALACTIC_EVERYWHERE bool operator()(std::uint32_t /*x*/, std::uint32_t /*y*/, Lanes /*z*/) const {
    return true;
  }
};

/// Passes the pixels where the surface of the triangle with these records has no hole.
struct SurfacePass {
  const PaneTask* task;
  std::int32_t least_alpha;
  float record[kRecordStride];
  float colors[kRecordStride];

  GALACTIC_EVERYWHERE bool operator()(std::uint32_t x, std::uint32_t y, Lanes z) const {
    const PixelLanes pixels{Lanes(static_cast<float>(x)), Lanes(static_cast<float>(y)),
                            Lanes(1.0F) / z};
    return alphaPasses(*task, OneRecord{record}, OneRecord{colors}, least_alpha, pixels).v != 0;
  }
};

/// Draws one pixel of every block, as a target of coverTriangle().
template <class Test>
struct PixelTarget {
  const DrawPlace* place;
  const Test* test;
  std::uint32_t lane, piece;
  std::uint32_t column = 0;
  std::uint32_t row = 0;
  std::uint32_t first_column = 0;

  GALACTIC_EVERYWHERE void start(std::uint32_t at_column, std::uint32_t at_row) {
    column = first_column = at_column;
    row = at_row;
  }
  GALACTIC_EVERYWHERE void right() { ++column; }
  GALACTIC_EVERYWHERE void nextRow() {
    column = first_column;
    ++row;
  }
  GALACTIC_EVERYWHERE IntLanes cover(const EdgeLanes& edges, Lanes z) const {
    if (signBits(edges.a | edges.b | edges.c) != 0) return 0;
    const std::uint32_t x = column * kBlockWidth + lane % kBlockWidth;
    const std::uint32_t y = row * kBlockHeight + lane / kBlockWidth;
    if (x >= place->task->width || y >= place->task->height) return 0;
    const std::size_t columns = place->tile_columns * (kTileEdge / kBlockWidth);
    std::uint64_t* pixel = place->pixels + (row * columns + column) * kWidth + lane;
    const std::uint64_t seen = seenAt(z[0], place->rank, piece);
    if (loadAtomically(pixel) >= seen || !(*test)(x, y, z)) return 0;
    raiseAtomically(pixel, seen);
    return -1;
  }
};

/// Finds out whether the cluster may be visible behind what the first pass drew; sets `shown`.
GALACTIC_EVERYWHERE inline void lookBehind(const Block& block, const DrawPlace& place,
                                           DrawShared& shared) {
  block.each([&](std::uint32_t thread) {
    if (thread == 0) shared.shown = 0;
  });
  block.each([&](std::uint32_t thread) {
    const SeenCluster& seen = *place.seen;
    const std::uint32_t wide = seen.tiles[1] - seen.tiles[0] + 1U;
    const std::uint32_t count = wide * (seen.tiles[3] - seen.tiles[2] + 1U);
    for (std::uint32_t n = thread; n < count; n += block.threads) {
      const std::uint32_t x = seen.tiles[0] + n % wide;
      const std::uint32_t y = seen.tiles[2] + n / wide;
      if (place.tile_depth[y * place.tile_columns + x] < seen.nearest) {
        storeAtomically(&shared.shown, 1U);
      }
    }
  });
}

GALACTIC_EVERYWHERE inline void beginCluster(const Block& block, const DrawPlace& place,
                                             DrawShared& shared) {
  block.each([&](std::uint32_t thread) {
    if (thread != 0) return;
    const PlacedModel& placed = place.task->models[place.seen->model];
    shared.frame = vertexFrame(*place.task, placed);
    ClusterState& state = shared.state;
    state.facts = clusterFacts(placed, place.seen->cluster);
    state.frame = &shared.frame;
    state.colors = clusterColors(state.facts);
    shared.state.any_bad = false;
    shared.small_count = shared.shared_count = shared.large_count = shared.cut_count = 0;
  });
  block.each([&](std::uint32_t thread) {
    ClusterState& state = shared.state;
    const ClusterFacts& facts = state.facts;
    const bool reads = facts.surface.least_alpha != 0 && facts.isTextured();
    for (std::uint32_t v = thread; v < facts.cluster->vertex_count; v += block.threads) {
      const std::uint16_t* vertex = vertexBlock(facts, v) + v % kWidth;
      if (placeVector(shared.frame, *facts.cluster, {vertex}, v, state) == 0) {
        storeAtomically(&state.any_bad, true);
      }
      if (reads) readVector({vertex}, v, state);
    }
  });
}

/// The corners of triangle `number` of a cluster.
GALACTIC_EVERYWHERE inline CornerLanes triangleCorners(const ClusterFacts& facts,
                                                       std::uint32_t number) {
  const std::size_t first = facts.cluster->first_triangle + number / kWidth * kWidth;
  return cornersAt(facts.pack->triangles + first * kTriangleRows + number % kWidth);
}

GALACTIC_EVERYWHERE inline void noteTriangle(std::uint8_t* list, std::uint32_t* count,
                                             std::uint32_t number) {
  list[addAtomically(count, 1U)] = static_cast<std::uint8_t>(number);
}

/// Lists the triangles that can cover a pixel, and sets up the small ones. `compares`: whether to
/// leave out small ones that the tiles' depths hide.
GALACTIC_EVERYWHERE inline void sortTriangles(const Block& block, const DrawPlace& place,
                                              bool compares, DrawShared& shared) {
  block.each([&](std::uint32_t thread) {
    const ClusterState& state = shared.state;
    const RenderCluster& cluster = *state.facts.cluster;
    const SortLimits limits = sortLimits(*place.task, cluster);
    const TileDepths tiles{place.tile_depth, static_cast<std::int32_t>(place.tile_columns)};
    for (std::uint32_t t = thread; t < cluster.triangle_count; t += block.threads) {
      const CornerLanes corners = triangleCorners(state.facts, t);
      if (state.any_bad) {
        const ClipSorting clip = sortForClipping(state, corners);
        if ((clip.cut & 1U) != 0) noteTriangle(shared.cut, &shared.cut_count, t);
        if (clip.whole == 0) continue;
      }
      const Sorting sorting = sortVector(limits, state, corners);
      if (sorting.large != 0) noteTriangle(shared.large, &shared.large_count, t);
      if (sorting.small == 0) continue;
      if (compares && behindTiles(tiles, state, sorting, corners) != 0) continue;
      const std::uint32_t at = addAtomically(&shared.small_count, 1U);
      shared.small[at] = static_cast<std::uint8_t>(t);
      shared.boxes[at] = {static_cast<std::uint8_t>(sorting.first_x.v),
                          static_cast<std::uint8_t>(sorting.last_x.v),
                          static_cast<std::uint8_t>(sorting.first_y.v),
                          static_cast<std::uint8_t>(sorting.last_y.v)};
      SmallGroup group;
      setUpGroup(*place.task, state, packed(corners), group, shared.setups[at]);
    }
  });
}

/// Writes the records of a small triangle.
template <class State>
GALACTIC_EVERYWHERE inline void recordSmall(const State& state, const SmallGroup& group,
                                            float* record, float* colors) {
  Lanes fields[kRecordStride];
  for (Lanes& field : fields) field = Lanes(0);
  texturePlanes(state, group, fields);
  surfacePlanes(state, group, fields + kTexels);
  for (std::uint32_t n = 0; n < kRecordStride; ++n) record[n] = fields[n].v;
  if (state.facts.color_kind != kHasColors) return;
  colorPlanes(state, group, fields);
  for (std::uint32_t n = 0; n < kColorFields; ++n) colors[n] = fields[n].v;
}

GALACTIC_EVERYWHERE inline SurfacePass surfacePass(const DrawPlace& place,
                                                   const ClusterState& state) {
  SurfacePass pass;
  pass.task = place.task;
  pass.least_alpha = static_cast<std::int32_t>(state.facts.surface.least_alpha);
  return pass;
}

/// Draws one pixel of every block of a small triangle whose surface has holes. Not inline, so that
/// its data takes no registers from the drawing of surfaces without holes.
GALACTIC_EVERYWHERE __attribute__((noinline)) void drawSmallSurface(const DrawPlace& place,
                                                                    const ClusterState& state,
                                                                    std::uint32_t number,
                                                                    std::uint32_t lane) {
  SurfacePass pass = surfacePass(place, state);
  SmallGroup group;
  GroupSetup setup;
  setUpGroup(*place.task, state, packed(triangleCorners(state.facts, number)), group, setup);
  recordSmall(state, group, pass.record, pass.colors);
  PixelTarget<SurfacePass> target{&place, &pass, lane, number};
  coverTriangle(setup, 0, pixelOf(lane), target);
}

/// A triangle that can cover at most this many pixels is drawn by a single thread, because eight
/// threads would test blocks most of whose pixels lie beside the triangle.
constexpr std::uint32_t kMostAlone = 64;

/// 1/w at a pixel, counted from the first pixel of the first block. It is summed up from block to
/// block, as in coverTriangle(), so that both round alike.
GALACTIC_EVERYWHERE inline float depthAt(const GroupSetup& setup, std::uint32_t x,
                                         std::uint32_t y) {
  const float right = setup.z_right[0];
  const float down = setup.z_down[0];
  float z = setup.z[0] + static_cast<float>(x % kBlockWidth) * right +
            static_cast<float>(y % kBlockHeight) * down;
  for (std::uint32_t row = y / kBlockHeight; row != 0; --row) z = z + down * 2;
  for (std::uint32_t column = x / kBlockWidth; column != 0; --column) z = z + right * 4;
  return lesserOf(greaterOf(z, setup.z_low[0]), setup.z_high[0]);
}

/// Draws a small triangle pixel by pixel.
GALACTIC_EVERYWHERE inline void coverAlone(const DrawPlace& place, const GroupSetup& setup,
                                           const PixelBox& box, std::uint32_t piece) {
  const std::uint32_t first_x = static_cast<std::uint32_t>(setup.first_column[0]) * kBlockWidth;
  const std::uint32_t first_y = static_cast<std::uint32_t>(setup.first_row[0]) * kBlockHeight;
  const IntLanes right[3] = {setup.edge_right[0][0], setup.edge_right[1][0],
                             setup.edge_right[2][0]};
  const auto at_start = [&](int n) {
    return IntLanes(setup.edge[n][0]) +
           right[n] * IntLanes(static_cast<std::int32_t>(box.left - first_x)) +
           IntLanes(setup.edge_down[n][0]) * IntLanes(static_cast<std::int32_t>(box.top - first_y));
  };
  EdgeLanes row{at_start(0), at_start(1), at_start(2)};
  const std::size_t columns = place.tile_columns * (kTileEdge / kBlockWidth);
  for (std::uint32_t y = box.top; y <= box.bottom; ++y) {
    EdgeLanes edges = row;
    for (std::uint32_t x = box.left; x <= box.right; ++x) {
      if (signBits(edges.a | edges.b | edges.c) == 0) {
        const float z = depthAt(setup, x - first_x, y - first_y);
        raiseAtomically(place.pixels + (y / kBlockHeight * columns + x / kBlockWidth) * kWidth +
                            y % kBlockHeight * kBlockWidth + x % kBlockWidth,
                        seenAt(z, place.rank, piece));
      }
      edges = {edges.a + right[0], edges.b + right[1], edges.c + right[2]};
    }
    row = {row.a + IntLanes(setup.edge_down[0][0]), row.b + IntLanes(setup.edge_down[1][0]),
           row.c + IntLanes(setup.edge_down[2][0])};
  }
}

/// Draws the small triangles that need only one thread, and lists the others.
GALACTIC_EVERYWHERE inline void drawAlone(const Block& block, const DrawPlace& place,
                                          DrawShared& shared, std::uint32_t thread) {
  const bool has_holes = shared.state.facts.surface.least_alpha != 0;
  for (std::uint32_t n = thread; n < shared.small_count; n += block.threads) {
    const PixelBox box = shared.boxes[n];
    const std::uint32_t pixels = (box.right - box.left + 1U) * (box.bottom - box.top + 1U);
    if (has_holes || pixels > kMostAlone) {
      noteTriangle(shared.shared_small, &shared.shared_count, n);
    } else {
      coverAlone(place, shared.setups[n], box, shared.small[n]);
    }
  }
}

/// Draws the small triangles that several threads share.
GALACTIC_EVERYWHERE inline void drawSmall(const Block& block, const DrawPlace& place,
                                          const DrawShared& shared, std::uint32_t thread) {
  const ClusterState& state = shared.state;
  const std::uint32_t lane = thread % kTeam;
  for (std::uint32_t n = thread / kTeam; n < shared.shared_count; n += block.threads / kTeam) {
    const std::uint32_t at = shared.shared_small[n];
    const std::uint32_t number = shared.small[at];
    if (state.facts.surface.least_alpha == 0) {
      const AllPass all;
      PixelTarget<AllPass> target{&place, &all, lane, number};
      coverTriangle(shared.setups[at], 0, pixelOf(lane), target);
      continue;
    }
    drawSmallSurface(place, state, number, lane);
  }
}

/// Draws the thread's share of the tiles of a large triangle.
template <class Test>
GALACTIC_EVERYWHERE inline void coverTiles(const Block& block, const LargeSetup& setup,
                                           const TileBox& tiles, std::uint32_t thread,
                                           PixelTarget<Test> target) {
  const auto wide = static_cast<std::uint32_t>(tiles.right - tiles.left + 1);
  const std::uint32_t count = wide * static_cast<std::uint32_t>(tiles.bottom - tiles.top + 1);
  for (std::uint32_t n = thread / kTeam; n < count; n += block.threads / kTeam) {
    const std::int32_t x = tiles.left + static_cast<std::int32_t>(n % wide);
    const std::int32_t y = tiles.top + static_cast<std::int32_t>(n / wide);
    EdgeLanes edges;
    if (tileEdges(setup, x, y, edges)) coverTile(setup, edges, x, y, target);
  }
}

/// Draws one large triangle whose surface has holes, with all threads. Not inline, for the same
/// reason as drawSmallSurface().
GALACTIC_EVERYWHERE __attribute__((noinline)) void drawLargeSurface(
    const Block& block, const DrawPlace& place, const ClusterState& state, const Corner* corners,
    std::uint32_t piece, std::uint32_t thread) {
  LargeTriangle triangle;
  const bool two_sided = state.facts.cluster->two_sided != 0;
  if (!faces(corners[0], corners[1], corners[2], two_sided, triangle)) return;
  const TileBox tiles = tilesOf(*place.task, triangle);
  if (tiles.right < tiles.left) return;
  const std::uint32_t lane = thread % kTeam;
  LargeSetup setup = setUpLarge(triangle);
  setOffsets(setup, pixelOf(lane));
  SurfacePass pass = surfacePass(place, state);
  recordLarge(state, triangle, setup.depth, pass.record, pass.colors);
  coverTiles(block, setup, tiles, thread, PixelTarget<SurfacePass>{&place, &pass, lane, piece});
}

/// The corners of a triangle that needs no clipping.
GALACTIC_EVERYWHERE inline void largeCorners(const ClusterState& state, std::uint32_t number,
                                             Corner* corners) {
  const CornerLanes at = triangleCorners(state.facts, number);
  corners[0] = cornerOf(state, static_cast<std::uint32_t>(at.a.v));
  corners[1] = cornerOf(state, static_cast<std::uint32_t>(at.b.v));
  corners[2] = cornerOf(state, static_cast<std::uint32_t>(at.c.v));
}

/// Clips a triangle and calls `draw` with three corners and the number of the piece for each
/// triangle that is left.
template <class Draw>
GALACTIC_EVERYWHERE inline void eachOfFan(const ClusterState& state, std::uint32_t number,
                                          const Draw& draw) {
  const CornerLanes at = triangleCorners(state.facts, number);
  Corner ready[kMostCorners];
  const int count =
      clipTriangle(state, static_cast<std::uint32_t>(at.a.v), static_cast<std::uint32_t>(at.b.v),
                   static_cast<std::uint32_t>(at.c.v), ready);
  for (int m = 1; m + 1 < count; ++m) {
    const Corner corners[3] = {ready[0], ready[m], ready[m + 1]};
    draw(corners, kFirstCut + number * kMostInFan + static_cast<std::uint32_t>(m - 1));
  }
}

/// Draws large and clipped triangles of a surface with holes, one by one. Each thread sets up all
/// of them.
GALACTIC_EVERYWHERE __attribute__((noinline)) void drawLargeSurfaces(const Block& block,
                                                                     const DrawPlace& place,
                                                                     const DrawShared& shared,
                                                                     std::uint32_t thread) {
  const ClusterState& state = shared.state;
  for (std::uint32_t n = 0; n < shared.large_count; ++n) {
    Corner corners[3];
    largeCorners(state, shared.large[n], corners);
    drawLargeSurface(block, place, state, corners, kFirstLarge + shared.large[n], thread);
  }
  for (std::uint32_t n = 0; n < shared.cut_count; ++n) {
    eachOfFan(state, shared.cut[n], [&](const Corner* corners, std::uint32_t piece) {
      drawLargeSurface(block, place, state, corners, piece, thread);
    });
  }
}

/// Sets up a triangle that all threads will draw.
GALACTIC_EVERYWHERE inline void notePiece(const DrawPlace& place, const Corner* corners,
                                          std::uint32_t piece, DrawShared& shared) {
  LargeTriangle triangle;
  const bool two_sided = shared.state.facts.cluster->two_sided != 0;
  if (!faces(corners[0], corners[1], corners[2], two_sided, triangle)) return;
  const TileBox tiles = tilesOf(*place.task, triangle);
  if (tiles.right < tiles.left) return;
  shared.pieces[addAtomically(&shared.piece_count, 1U)] = {setUpLarge(triangle), tiles, piece};
}

/// Clips a triangle and sets up what is left. Not inline, because few clusters have triangles to
/// clip, and clipping takes all registers.
GALACTIC_EVERYWHERE __attribute__((noinline)) void noteCut(const DrawPlace& place,
                                                           std::uint32_t number,
                                                           DrawShared& shared) {
  eachOfFan(shared.state, number, [&](const Corner* corners, std::uint32_t piece) {
    notePiece(place, corners, piece, shared);
  });
}

/// Draws the pieces that were set up. The teams of threads take their tiles in turn. `compares`:
/// whether to leave out tiles in which a piece is hidden.
GALACTIC_EVERYWHERE inline void drawPieces(const Block& block, const DrawPlace& place,
                                           bool compares, const DrawShared& shared,
                                           std::uint32_t thread) {
  const std::uint32_t lane = thread % kTeam;
  const std::uint32_t teams = block.threads / kTeam;
  const AllPass all;
  // The team that takes the next tile.
  std::uint32_t team = 0;
  for (std::uint32_t p = 0; p < shared.piece_count; ++p) {
    const TileBox tiles = shared.pieces[p].tiles;
    const auto wide = static_cast<std::uint32_t>(tiles.right - tiles.left + 1);
    const std::uint32_t count = wide * static_cast<std::uint32_t>(tiles.bottom - tiles.top + 1);
    std::uint32_t n = (thread / kTeam + teams - team) % teams;
    team = (team + count) % teams;
    if (n >= count) continue;
    LargeSetup setup = shared.pieces[p].setup;
    setOffsets(setup, pixelOf(lane));
    PixelTarget<AllPass> target{&place, &all, lane, shared.pieces[p].piece};
    for (; n < count; n += teams) {
      const std::int32_t x = tiles.left + static_cast<std::int32_t>(n % wide);
      const std::int32_t y = tiles.top + static_cast<std::int32_t>(n / wide);
      EdgeLanes edges;
      if (!tileEdges(setup, x, y, edges)) continue;
      const auto tile =
          static_cast<std::uint32_t>(y) * place.tile_columns + static_cast<std::uint32_t>(x);
      if (compares && place.tile_depth[tile] >= nearestInTile(setup, x, y)) continue;
      coverTile(setup, edges, x, y, target);
    }
  }
}

/// Draws the triangles that are not small. One thread sets up each triangle, and all threads draw
/// it.
GALACTIC_EVERYWHERE inline void drawAllLarge(const Block& block, const DrawPlace& place,
                                             bool compares, DrawShared& shared) {
  const auto draw_together = [&](const auto& note, std::uint32_t count, std::uint32_t together) {
    for (std::uint32_t first = 0; first < count; first += together) {
      block.each([&](std::uint32_t thread) {
        if (thread == 0) shared.piece_count = 0;
      });
      block.each([&](std::uint32_t thread) {
        for (std::uint32_t n = thread; n < together && first + n < count; n += block.threads) {
          note(first + n);
        }
      });
      block.each([&](std::uint32_t thread) { drawPieces(block, place, compares, shared, thread); });
    }
  };
  const auto note_large = [&](std::uint32_t n) {
    Corner corners[3];
    largeCorners(shared.state, shared.large[n], corners);
    notePiece(place, corners, kFirstLarge + shared.large[n], shared);
  };
  const auto note_cut = [&](std::uint32_t n) { noteCut(place, shared.cut[n], shared); };
  draw_together(note_large, shared.large_count, kMostPieces);
  draw_together(note_cut, shared.cut_count, kMostCutTogether);
}

/// Draws the block's share of the clusters of a pass.
GALACTIC_EVERYWHERE inline void drawClusters(const Block& block, DrawShared& shared,
                                             const ViewSlice& slice, std::uint32_t pass) {
  const std::uint32_t count = slice.counts->items[pass];
  block.each([&](std::uint32_t thread) {
    if (thread == 0) shared.clusters_drawn = shared.triangles_drawn = 0;
  });
  for (std::uint32_t n = block.index; n < count; n += block.count) {
    const DrawPlace place = drawPlace(slice, slice.items[pass][n]);
    const bool compares = pass != 0 && place.task->culling;
    if (compares) {
      lookBehind(block, place, shared);
      if (shared.shown == 0) continue;
    }
    beginCluster(block, place, shared);
    sortTriangles(block, place, compares, shared);
    block.each([&](std::uint32_t thread) { drawAlone(block, place, shared, thread); });
    block.each([&](std::uint32_t thread) { drawSmall(block, place, shared, thread); });
    if (shared.state.facts.surface.least_alpha == 0) {
      drawAllLarge(block, place, compares, shared);
    } else {
      block.each([&](std::uint32_t thread) { drawLargeSurfaces(block, place, shared, thread); });
    }
    block.each([&](std::uint32_t thread) {
      if (thread != 0) return;
      ++shared.clusters_drawn;
      shared.triangles_drawn += shared.small_count + shared.large_count + shared.cut_count;
    });
  }
  block.each([&](std::uint32_t thread) {
    if (thread != 0) return;
    addAtomically(&slice.counts->clusters_drawn, shared.clusters_drawn);
    addAtomically(&slice.counts->triangles_drawn, shared.triangles_drawn);
  });
}

/// Measures the least 1/w of the tiles of the block's pane. Each block has one pane.
GALACTIC_EVERYWHERE inline void measureTiles(const Block& block, const ViewSlice& slice) {
  const std::uint32_t pane = block.index;
  const PaneTask& task = slice.tasks[pane];
  const std::uint64_t* pixels =
      slice.pixels + static_cast<std::size_t>(pane) * slice.pixels_of_pane;
  float* depths = slice.tile_depth + static_cast<std::size_t>(pane) * slice.tiles_of_pane;
  const std::uint32_t wide = (task.width + kTileEdge - 1) / kTileEdge;
  const std::uint32_t high = (task.height + kTileEdge - 1) / kTileEdge;
  block.each([&](std::uint32_t thread) {
    for (std::uint32_t tile = thread; tile < wide * high; tile += block.threads) {
      float least = __builtin_inff();
      for (std::uint32_t n = 0; n < kTileEdge * kTileEdge; ++n) {
        const std::uint32_t x = tile % wide * kTileEdge + n % kTileEdge;
        const std::uint32_t y = tile / wide * kTileEdge + n / kTileEdge;
        if (x >= task.width || y >= task.height) continue;
        const std::size_t at =
            (static_cast<std::size_t>(y / kBlockHeight) * (2 * wide) + x / kBlockWidth) * kWidth +
            y % kBlockHeight * kBlockWidth + x % kBlockWidth;
        least = lesserOf(depthOfSeen(pixels[at]), least);
      }
      depths[tile] = least;
    }
  });
}

}  // namespace
}  // namespace galactic::render::cuda
