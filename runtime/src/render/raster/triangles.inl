// Triangles of a cluster: which of them can cover a pixel, and the set-up of a vector of them.
namespace galactic::render {
namespace {

/// Triangles that are no larger than this, in 1/256 pixel, are set up as vectors of 32-bit numbers.
constexpr std::int32_t kSmall = 64 * kSubpixels;

/// Corners of some triangles, given by the numbers of the vertices in their cluster.
struct CornerLanes {
  IntLanes a, b, c;
};

/// Corners in one integer, with the first in the lowest byte.
GALACTIC_EVERYWHERE inline IntLanes packed(const CornerLanes& corners) {
  return corners.a | corners.b << 8 | corners.c << 16;
}
GALACTIC_EVERYWHERE inline CornerLanes unpacked(IntLanes corners) {
  return {corners & 0xFF, (corners >> 8) & 0xFF, (corners >> 16) & 0xFF};
}

/// The corners of a vector of triangles: of a block of eight and, if a vector takes two blocks, of
/// the block `next` numbers further. Two corners are swapped: packs have corners counter-clockwise
/// as seen from outside, drawing has them clockwise on the screen.
GALACTIC_EVERYWHERE inline CornerLanes cornersAt(const std::uint8_t* block, std::size_t next = 0) {
  return {loadRows(block, next), loadRows(block + std::size_t{2} * kWidth, next),
          loadRows(block + kWidth, next)};
}

struct PointLanes {
  IntLanes x, y;
};

template <class State>
GALACTIC_EVERYWHERE inline PointLanes pointsOf(const State& state, IntLanes corner) {
  const Pair<IntLanes> xy = lookUpPairs(state.xy, corner);
  return {xy.first, xy.second};
}

GALACTIC_EVERYWHERE inline IntLanes leastOf(IntLanes a, IntLanes b, IntLanes c) {
  return lesser(lesser(a, b), c);
}
GALACTIC_EVERYWHERE inline IntLanes mostOf(IntLanes a, IntLanes b, IntLanes c) {
  return greater(greater(a, b), c);
}
GALACTIC_EVERYWHERE inline Lanes leastOf(Lanes a, Lanes b, Lanes c) {
  return lesser(lesser(a, b), c);
}
GALACTIC_EVERYWHERE inline Lanes mostOf(Lanes a, Lanes b, Lanes c) {
  return greater(greater(a, b), c);
}

/// First and last pixel whose center lies between two positions.
GALACTIC_EVERYWHERE inline IntLanes firstPixel(IntLanes lowest) {
  return (lowest + spread(kSubpixels / 2 - 1)) >> 8;
}
GALACTIC_EVERYWHERE inline IntLanes lastPixel(IntLanes highest) {
  return (highest - spread(kSubpixels / 2)) >> 8;
}

/// Twice the area, positive if the corners go clockwise on the screen. Exact for small triangles.
GALACTIC_EVERYWHERE inline IntLanes doubleArea(const PointLanes& a, const PointLanes& b,
                                               const PointLanes& c) {
  return wrapSubtract(wrapMultiply(b.x - a.x, c.y - a.y), wrapMultiply(c.x - a.x, b.y - a.y));
}

/// How some triangles are drawn, if at all: bit n for triangle n.
struct Sorting {
  unsigned small, large;
  /// First and last pixels that the small ones can cover.
  IntLanes first_x, last_x, first_y, last_y;
};

/// Bounds of a pane, and whether both sides of triangles are visible. They are passed by value, so
/// that the compiler knows that no store changes them.
struct SortLimits {
  IntLanes last_x, last_y, two_sided;
};

GALACTIC_EVERYWHERE inline SortLimits sortLimits(const PaneTask& task,
                                                 const RenderCluster& cluster) {
  return {spread(static_cast<std::int32_t>(task.width) - 1),
          spread(static_cast<std::int32_t>(task.height) - 1),
          spread(cluster.two_sided != 0 ? -1 : 0)};
}

/// The bits of ClusterState::bad that belong to clip planes.
constexpr std::int32_t kClipBits = 31;

/// Which of some triangles have no bad corner, and which have to be cut: bit n for triangle n. The
/// others have all their corners beyond the same plane.
struct ClipSorting {
  unsigned whole, cut;
};

GALACTIC_EVERYWHERE inline ClipSorting sortForClipping(const ClusterState& state,
                                                       const CornerLanes& corners) {
  const IntLanes a = lookUp(state.bad, corners.a);
  const IntLanes b = lookUp(state.bad, corners.b);
  const IntLanes c = lookUp(state.bad, corners.c);
  const unsigned whole = signBits(((a | b | c) & kClipBits) == spread(0));
  return {whole, ~(whole | signBits((a & b & c) != spread(0)))};
}

GALACTIC_EVERYWHERE inline Sorting sortVector(const SortLimits limits, const ClusterState& state,
                                              const CornerLanes& corners) {
  const PointLanes a = pointsOf(state, corners.a);
  const PointLanes b = pointsOf(state, corners.b);
  const PointLanes c = pointsOf(state, corners.c);
  const IntLanes x_low = leastOf(a.x, b.x, c.x);
  const IntLanes x_high = mostOf(a.x, b.x, c.x);
  const IntLanes y_low = leastOf(a.y, b.y, c.y);
  const IntLanes y_high = mostOf(a.y, b.y, c.y);
  const IntLanes first_x = greater(firstPixel(x_low), spread(0));
  const IntLanes first_y = greater(firstPixel(y_low), spread(0));
  const IntLanes last_x = lesser(lastPixel(x_high), limits.last_x);
  const IntLanes last_y = lesser(lastPixel(y_high), limits.last_y);
  // Compares by the signs of differences, which cannot wrap around here.
  const IntLanes missed = (last_x - first_x) | (last_y - first_y);
  const IntLanes large = (spread(kSmall) - (x_high - x_low)) | (spread(kSmall) - (y_high - y_low));
  const IntLanes area = doubleArea(a, b, c);
  const IntLanes turned_away =
      (area == spread(0)) | (wrapSubtract(area, spread(1)) & ~limits.two_sided);
  return {signBits(~(missed | large | turned_away)),
          signBits(~missed & large),
          first_x,
          last_x,
          first_y,
          last_y};
}

/// The tiles that some triangles touch, at most two in a row and in a column. Triangles whose mask
/// is 0 do not count.
struct TouchedTiles {
  IntLanes left, right, top, bottom, mask;
};

/// A lower bound of the least 1/w of each tile of a pane, row by row. One more number may be read.
struct TileDepths {
  const float* depth;
  std::int32_t columns;

  /// The least 1/w of the tiles of each triangle.
  GALACTIC_EVERYWHERE Lanes farthest(const TouchedTiles& tiles) const {
    const IntLanes upper = tiles.top * spread(columns) + tiles.left;
    const IntLanes lower = tiles.bottom * spread(columns) + tiles.left;
    const IntLanes both = tiles.left < tiles.right;
    return lesser(gatherLeast(depth, upper & tiles.mask, both & tiles.mask),
                  gatherLeast(depth, lower & tiles.mask, both & tiles.mask));
  }
};

/// Which of some small triangles lie behind everything that was drawn in their tiles: bit n for
/// triangle n. Triangles that touch more than two tiles in a row or a column do not count.
template <class Tiles>
GALACTIC_EVERYWHERE inline unsigned behindTiles(const Tiles& tiles, const ClusterState& state,
                                                const Sorting& sorting,
                                                const CornerLanes& corners) {
  const Lanes nearest =
      mostOf(lookUp(state.z, corners.a), lookUp(state.z, corners.b), lookUp(state.z, corners.c));
  TouchedTiles touched{sorting.first_x >> 3, sorting.last_x >> 3, sorting.first_y >> 3,
                       sorting.last_y >> 3, spread(0)};
  // The last two terms exclude triangles that cover no pixel, since they may lie outside the pane.
  const IntLanes wide = touched.right - touched.left;
  const IntLanes high = touched.bottom - touched.top;
  touched.mask = ~(wide | (spread(1) - wide) | high | (spread(1) - high) |
                   (sorting.last_x - sorting.first_x) | (sorting.last_y - sorting.first_y)) >>
                 31;
  return signBits((tiles.farthest(touched) >= nearest) & touched.mask);
}

/// How a value that is given at the corners of a triangle changes per pixel to the right and down.
struct GradientLanes {
  Lanes right, down;
};

/// Corners of some small triangles.
struct SmallGroup {
  CornerLanes corners;
  PointLanes a, b, c;
  /// The edges from a to b and to c, and 256 / double area.
  Lanes ab_x, ab_y, ac_x, ac_y, per_area;
  /// 1/w at the corners, and how it changes.
  Lanes z_a, z_b, z_c;
  GradientLanes z;
};

GALACTIC_EVERYWHERE inline GradientLanes gradient(const SmallGroup& group, Lanes a, Lanes b,
                                                  Lanes c) {
  const Lanes ab = b - a;
  const Lanes ac = c - a;
  return {(group.ac_y * ab - group.ab_y * ac) * group.per_area,
          (group.ab_x * ac - group.ac_x * ab) * group.per_area};
}

/// A vector of triangles, ready to be drawn. Values are at the center of the first pixel of the
/// first block or, for edge functions, of the first vector of blocks. Edge functions are not
/// negative inside the triangle. "right" and "down": changes per pixel.
struct alignas(kGroupAlignment) GroupSetup {
  std::int32_t edge[3][kLanes], edge_right[3][kLanes], edge_down[3][kLanes];
  float z[kLanes], z_right[kLanes], z_down[kLanes];
  /// Range of 1/w at the corners. Pixels are clamped to it, because 1/w of a thin triangle could
  /// leave it.
  float z_low[kLanes], z_high[kLanes];
  /// First and last column and row, in blocks.
  std::int32_t first_column[kLanes], last_column[kLanes], first_row[kLanes], last_row[kLanes];
};

GALACTIC_EVERYWHERE inline void setUpEdge(GroupSetup& setup, int number, const PointLanes& from,
                                          const PointLanes& to, const PointLanes& start) {
  const IntLanes dx = to.x - from.x;
  const IntLanes dy = to.y - from.y;
  const IntLanes value = dx * (start.y - from.y) - dy * (start.x - from.x);
  // Pixels exactly on an edge belong to the triangle if the edge is a left one or a horizontal
  // upper one.
  const IntLanes keeps = (dy < spread(0)) | ((dy == spread(0)) & (dx > spread(0)));
  store(setup.edge[number], value + ~keeps);
  store(setup.edge_right[number], dy * spread(-kSubpixels));
  store(setup.edge_down[number], dx * spread(kSubpixels));
}

/// Sets up a vector of small triangles. Turns around those that show their back.
template <class State>
GALACTIC_EVERYWHERE inline void setUpGroup(const PaneTask& task, const State& state,
                                           IntLanes packed_corners, SmallGroup& group,
                                           GroupSetup& setup) {
  group.corners = unpacked(packed_corners);
  group.a = pointsOf(state, group.corners.a);
  group.b = pointsOf(state, group.corners.b);
  group.c = pointsOf(state, group.corners.c);
  IntLanes area = doubleArea(group.a, group.b, group.c);
  if (state.facts.cluster->two_sided != 0) {
    const IntLanes back = area < spread(0);
    const CornerLanes k = group.corners;
    const PointLanes b = group.b;
    const PointLanes c = group.c;
    group.corners = {k.a, pick(back, k.c, k.b), pick(back, k.b, k.c)};
    group.b = {pick(back, c.x, b.x), pick(back, c.y, b.y)};
    group.c = {pick(back, b.x, c.x), pick(back, b.y, c.y)};
    area = pick(back, -area, area);
  }
  const PointLanes& a = group.a;
  const PointLanes& b = group.b;
  const PointLanes& c = group.c;
  const auto width = static_cast<std::int32_t>(task.width);
  const auto height = static_cast<std::int32_t>(task.height);
  const IntLanes first_column = greater(firstPixel(leastOf(a.x, b.x, c.x)), spread(0)) >> 2;
  const IntLanes first_row = greater(firstPixel(leastOf(a.y, b.y, c.y)), spread(0)) >> 1;
  store(setup.first_column, first_column);
  store(setup.first_row, first_row);
  store(setup.last_column, lesser(lastPixel(mostOf(a.x, b.x, c.x)), spread(width - 1)) >> 2);
  store(setup.last_row, lesser(lastPixel(mostOf(a.y, b.y, c.y)), spread(height - 1)) >> 1);
  const PointLanes start{(first_column << 10) + spread(kSubpixels / 2),
                         (first_row << 9) + spread(kSubpixels / 2)};
  const IntLanes first_of_vector = first_row & -static_cast<std::int32_t>(kBlocks);
  const PointLanes edge_start{start.x, (first_of_vector << 9) + spread(kSubpixels / 2)};
  setUpEdge(setup, 0, a, b, edge_start);
  setUpEdge(setup, 1, b, c, edge_start);
  setUpEdge(setup, 2, c, a, edge_start);
  group.ab_x = toFloat(b.x - a.x);
  group.ab_y = toFloat(b.y - a.y);
  group.ac_x = toFloat(c.x - a.x);
  group.ac_y = toFloat(c.y - a.y);
  group.per_area = spread(static_cast<float>(kSubpixels)) / toFloat(area);
  group.z_a = lookUp(state.z, group.corners.a);
  group.z_b = lookUp(state.z, group.corners.b);
  group.z_c = lookUp(state.z, group.corners.c);
  group.z = gradient(group, group.z_a, group.z_b, group.z_c);
  const Lanes per_subpixel = spread(1.0F / kSubpixels);
  const Lanes dx = toFloat(start.x - a.x) * per_subpixel;
  const Lanes dy = toFloat(start.y - a.y) * per_subpixel;
  store(setup.z, group.z_a + (group.z.right * dx + group.z.down * dy));
  store(setup.z_right, group.z.right);
  store(setup.z_down, group.z.down);
  store(setup.z_low, leastOf(group.z_a, group.z_b, group.z_c));
  store(setup.z_high, mostOf(group.z_a, group.z_b, group.z_c));
}

/// Values that change linearly over the pane.
struct EdgeLanes {
  IntLanes a, b, c;
};

}  // namespace
}  // namespace galactic::render
