// Triangles that are drawn one by one: large ones, and what clipping leaves of others.
namespace galactic::render {
namespace {

template <class Test>
bool coverTiles(const Pane& pane, const LargeSetup& setup, const TileBox& tiles, const Test& test) {
  PaneTarget target(pane, test);
  const PaneScratch& scratch = *pane.scratch;
  bool seen = false;
  for (std::int32_t y = tiles.top; y <= tiles.bottom; ++y) {
    for (std::int32_t x = tiles.left; x <= tiles.right; ++x) {
      EdgeLanes edges;
      if (!tileEdges(setup, x, y, edges)) continue;
      const std::size_t tile =
          static_cast<std::size_t>(y) * pane.tile_columns + static_cast<std::size_t>(x);
      const float nearest = nearestInTile(setup, x, y);
      // What is known of a tile is never too near, even where the tile has changed since.
      if (scratch.tile_depth[tile] >= nearest) continue;
      if (tileDepth(pane, static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y)) >=
          nearest) {
        continue;
      }
      if (signBits(coverTile(setup, edges, x, y, target)) == 0) continue;
      scratch.tile_changed[y] |= 1U << static_cast<unsigned>(x);
      seen = true;
    }
  }
  return seen;
}

/// Draws one triangle, whatever its size. Corners go clockwise on the screen where it shows its
/// face.
void drawLarge(Pane& pane, const ClusterState& state, const Corner& a, const Corner& b,
               const Corner& c) {
  LargeTriangle triangle;
  if (!faces(a, b, c, state.facts.cluster->two_sided != 0, triangle)) return;
  const TileBox tiles = tilesOf(*pane.task, triangle);
  if (tiles.right < tiles.left) return;
  ++pane.counts.triangles_drawn;
  LargeSetup setup = setUpLarge(triangle);
  setOffsets(setup, blockPixels());
  if (pane.records == kMostRecords) makeRoom(pane);
  float* record = recordAt(pane, pane.records);
  float* colors = colorsAt(pane, pane.records);
  bool seen = false;
  if (state.facts.surface.least_alpha != 0) {
    recordLarge(state, triangle, setup.depth, record, colors);
    seen = coverTiles(pane, setup, tiles, alphaTest(pane, state, record, colors));
  } else {
    seen = coverTiles(pane, setup, tiles, Opaque{});
    if (seen && pane.shades) recordLarge(state, triangle, setup.depth, record, colors);
  }
  if (seen && pane.shades) ++pane.records;
}

/// Draws what is left of a triangle, given by the numbers of its vertices.
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
