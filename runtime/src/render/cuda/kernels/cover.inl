// Pixels of a triangle: each thread takes one pixel of every block, where the `soft` renderer takes
// a vector of pixels.
namespace galactic::render {
namespace {

/// Offsets of pixels from the first one of their block.
struct PixelOffsets {
  IntLanes right, down;
};

/// Draws triangle `n` of a group, block by block, on a target with the functions start(column,
/// row), cover(edges, z), right() and nextRow(). The sign bits of the result are set for pixels in
/// which the triangle is visible.
template <class Target>
GALACTIC_EVERYWHERE inline IntLanes coverTriangle(const GroupSetup& group, unsigned n,
                                                  const PixelOffsets& pixels, Target& target) {
  const IntLanes right = pixels.right;
  const IntLanes lower = -pixels.down;
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
                toFloat(pixels.down) * spread(group.z_down[n]);
  const Lanes z_next = spread(group.z_right[n] * 4);
  const Lanes z_below = spread(group.z_down[n] * 2);
  const Lanes z_low = spread(group.z_low[n]);
  const Lanes z_high = spread(group.z_high[n]);
  IntLanes hit = spread(0);
  target.start(static_cast<std::uint32_t>(group.first_column[n]),
               static_cast<std::uint32_t>(group.first_row[n]));
  const auto columns = static_cast<std::uint32_t>(group.last_column[n] - group.first_column[n]);
  for (std::int32_t row = group.first_row[n]; row <= group.last_row[n]; ++row) {
    EdgeLanes edges = row_edges;
    Lanes z = row_z;
    for (std::uint32_t column = 0;; ++column) {
      hit |= target.cover(edges, lesser(greater(z, z_low), z_high));
      if (column == columns) break;
      edges = {edges.a + next.a, edges.b + next.b, edges.c + next.c};
      z = z + z_next;
      target.right();
    }
    row_edges = {row_edges.a + below.a, row_edges.b + below.b, row_edges.c + below.c};
    row_z = row_z + z_below;
    target.nextRow();
  }
  return hit;
}

/// Sets the offsets, which depend on the pixels of a block that are drawn.
GALACTIC_EVERYWHERE inline void setOffsets(LargeSetup& setup, const PixelOffsets& pixels) {
  for (LongEdge& edge : setup.edges) {
    edge.offsets = pixels.right * spread(edge.right) + pixels.down * spread(edge.down);
  }
  setup.z_offsets = toFloat(pixels.right) * spread(static_cast<float>(setup.depth.right)) +
                    toFloat(pixels.down) * spread(static_cast<float>(setup.depth.down));
}

/// An upper bound of 1/w in coverTile() for a tile: 1/w at a corner of the tile, plus a bound of
/// the rounding error of a sum of a few numbers.
GALACTIC_EVERYWHERE inline float nearestInTile(const LargeSetup& setup, std::int32_t tile_x,
                                               std::int32_t tile_y) {
  constexpr double kLast = kTileEdge - 1;
  constexpr double kSumRounding = 2e-6;
  const Plane& depth = setup.depth;
  const double right = depth.right * (tile_x * static_cast<double>(kTileEdge));
  const double down = depth.down * (tile_y * static_cast<double>(kTileEdge));
  const double start = depth.start + (right + down);
  const double nearest = start + (depth.right > 0 ? depth.right * kLast : 0) +
                         (depth.down > 0 ? depth.down * kLast : 0);
  const double size =
      __builtin_fabs(start) + kLast * (__builtin_fabs(depth.right) + __builtin_fabs(depth.down));
  const double most = nearest + size * kSumRounding;
  return most < static_cast<double>(setup.z_most) ? static_cast<float>(most) * 1.0000002F
                                                  : setup.z_most;
}

/// Computes the edge functions at the first block of a tile; returns whether the triangle can touch
/// the tile.
GALACTIC_EVERYWHERE inline bool tileEdges(const LargeSetup& setup, std::int32_t tile_x,
                                          std::int32_t tile_y, EdgeLanes& lanes) {
  constexpr std::int64_t kMost = 1 << 30;
  std::int32_t starts[3];
  for (int n = 0; n < 3; ++n) {
    const LongEdge& edge = setup.edges[n];
    constexpr std::int64_t kEdge = kTileEdge;
    const std::int64_t value =
        edge.start + edge.right * (kEdge * tile_x) + edge.down * (kEdge * tile_y);
    if (value + edge.reach < 0) return false;
    // Beyond this, the sign is the same in the whole tile, since changes per pixel are below 2^24.
    starts[n] = static_cast<std::int32_t>(value > kMost ? kMost : value < -kMost ? -kMost : value);
  }
  lanes = {setup.edges[0].offsets + spread(starts[0]), setup.edges[1].offsets + spread(starts[1]),
           setup.edges[2].offsets + spread(starts[2])};
  return true;
}

/// Draws the pixels of one tile, on a target as in coverTriangle(). `edges`: see tileEdges().
template <class Target>
GALACTIC_EVERYWHERE inline IntLanes coverTile(const LargeSetup& setup, EdgeLanes edges,
                                              std::int32_t tile_x, std::int32_t tile_y,
                                              Target& target) {
  const Plane& depth = setup.depth;
  const double x = tile_x * static_cast<double>(kTileEdge);
  const double y = tile_y * static_cast<double>(kTileEdge);
  const Lanes z_start =
      spread(static_cast<float>(depth.start + (depth.right * x + depth.down * y))) +
      setup.z_offsets;
  IntLanes hit = spread(0);
  const auto right = [&](int n) { return spread(setup.edges[n].right * 4); };
  const auto down = [&](int n) { return spread(setup.edges[n].down * 2); };
  const Lanes z_right = spread(static_cast<float>(depth.right * 4));
  target.start(static_cast<std::uint32_t>(tile_x) * 2, static_cast<std::uint32_t>(tile_y) * 4);
  for (std::uint32_t row = 0; row < 4; ++row) {
    const Lanes z = z_start + spread(static_cast<float>(depth.down * (2 * row)));
    hit |= target.cover(edges, lesser(greater(z, setup.z_low), setup.z_high));
    const EdgeLanes beside{edges.a + right(0), edges.b + right(1), edges.c + right(2)};
    target.right();
    hit |= target.cover(beside, lesser(greater(z + z_right, setup.z_low), setup.z_high));
    edges = {edges.a + down(0), edges.b + down(1), edges.c + down(2)};
    target.nextRow();
  }
  return hit;
}

}  // namespace
}  // namespace galactic::render
