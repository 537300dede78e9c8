// Triangles of a cluster: which of them are drawn, and in which way.
namespace galactic::render {
namespace {

/// Returns a lower bound of the least 1/w of the vertices, which means nothing if one of them is
/// bad.
float placeVertices(ClusterState& state) {
  const RenderCluster& cluster = *state.facts.cluster;
  const std::uint16_t* block = vertexBlock(state.facts, 0);
  unsigned bad = 0;
  Lanes farthest = spread(__builtin_inff());
  for (std::uint32_t v = 0; v < cluster.vertex_count; v += kLanes, block += kVertexRows * kLanes) {
    unsigned good = placeVector(*state.frame, cluster, vertexRows(cluster, block, v), v, state);
    // Lanes after the last vertex do not count as bad.
    if (cluster.vertex_count - v < kLanes) good |= kAllLanes << (cluster.vertex_count - v);
    bad |= ~good & kAllLanes;
    farthest = lesser(farthest, load<Lanes>(state.z + v));
  }
  state.any_bad = bad != 0;
  return least(farthest);
}

/// Marks the vertices that lie beside the pane. If all corners of a triangle lie beyond the same
/// edge, so does what clipping leaves of it, because clipping only adds corners between the
/// existing ones.
void markBeside(const PaneTask& task, ClusterState& state) {
  // The margin is one pixel, because corners move when they are rounded. kClipRounding bounds the
  // rounding errors before, relative to the size of what is added.
  constexpr float kMargin = kSubpixels;
  constexpr float kClipRounding = 4e-6F;
  const PaneEdges edges = paneEdges(task);
  const float widest = 128.0F * static_cast<float>(task.image_width + task.image_height) + kMargin;
  const RenderCluster& cluster = *state.facts.cluster;
  const std::uint16_t* block = vertexBlock(state.facts, 0);
  for (std::uint32_t v = 0; v < cluster.vertex_count; v += kLanes, block += kVertexRows * kLanes) {
    const VertexLanes at = vertexLanes(*state.frame, cluster, vertexRows(cluster, block, v));
    const auto beyond = [&](Lanes place, Lanes edge, std::int32_t bit) {
      const Lanes size = magnitude(place) + spread(widest) * magnitude(at.w);
      return (place - edge * at.w > size * spread(kClipRounding)) & bit;
    };
    const IntLanes beside = beyond(at.right, spread(edges.right + kMargin), 32) |
                            beyond(-at.right, spread(kMargin - edges.left), 64) |
                            beyond(at.down, spread(edges.bottom + kMargin), 128) |
                            beyond(-at.down, spread(kMargin - edges.top), 256);
    store(state.bad + v, load<IntLanes>(state.bad + v) | beside);
  }
}

/// Texture coordinates of all vertices, in texels of the largest level.
void readCoordinates(ClusterState& state) {
  if (state.has_coordinates) return;
  state.has_coordinates = true;
  const std::uint16_t* block = vertexBlock(state.facts, 0);
  const RenderCluster& cluster = *state.facts.cluster;
  for (std::uint32_t v = 0; v < cluster.vertex_count; v += kLanes, block += kVertexRows * kLanes) {
    readVector(vertexRows(cluster, block, v), v, state);
  }
}

/// Triangles of a cluster that are worth drawing, sorted by how they are drawn. Their corners go
/// clockwise on the screen if the triangle shows its face.
struct Survivors {
  /// Each list has room for a vector after its last triangle. After the last small and the last
  /// large one there is a vector of triangles whose corners are all vertex 0.
  alignas(64) std::int32_t small[kMostInCluster + kLanes];
  std::int32_t large[kMostInCluster + kLanes];
  std::int32_t clipped[kMostInCluster + kLanes];
  std::uint32_t small_count, large_count, clipped_count;
};

inline void append(std::int32_t* list, std::uint32_t& count, IntLanes corners, unsigned which) {
  storePicked(list + count, corners, which);
  count += static_cast<std::uint32_t>(__builtin_popcount(which));
}

/// The depths of a cluster's tiles, if these are so few that they can be looked up without loads.
struct FewTiles {
  alignas(kVectorBytes) float depth[kFewEntries + kLanes];
  std::int32_t wide, before;

  Lanes farthest(const TouchedTiles& tiles) const {
    const IntLanes upper = tiles.top * spread(wide) - spread(before);
    const IntLanes lower = tiles.bottom * spread(wide) - spread(before);
    return lesser(
        lesser(lookUpFew(depth, upper + tiles.left), lookUpFew(depth, upper + tiles.right)),
        lesser(lookUpFew(depth, lower + tiles.left), lookUpFew(depth, lower + tiles.right)));
  }
};

/// Returns false if there are too many tiles.
inline bool readFewTiles(const Pane& pane, const SeenCluster& seen, FewTiles& few) {
  few.wide = seen.tiles[1] - seen.tiles[0] + 1;
  const auto count = static_cast<std::uint32_t>(few.wide * (seen.tiles[3] - seen.tiles[2] + 1));
  if (count > kFewEntries) return false;
  few.before = seen.tiles[2] * few.wide + seen.tiles[0];
  float* to = few.depth;
  for (std::uint32_t y = seen.tiles[2]; y <= seen.tiles[3]; ++y, to += few.wide) {
    const float* from =
        pane.scratch->tile_depth + std::size_t{y} * pane.tile_columns + seen.tiles[0];
    store(to, load<Lanes>(from));
    if (few.wide > static_cast<std::int32_t>(kLanes))
      store(to + kLanes, load<Lanes>(from + kLanes));
  }
  return true;
}

/// `compares`: whether some of the triangles may lie behind what was drawn in their tiles.
void sortTriangles(const Pane& pane, const SeenCluster& seen, const ClusterState& state,
                   bool compares, Survivors& survivors) {
  const PaneTask& task = *pane.task;
  survivors.small_count = survivors.large_count = survivors.clipped_count = 0;
  const RenderCluster& cluster = *state.facts.cluster;
  const SortLimits limits = sortLimits(task, cluster);
  const TileDepths tiles{pane.scratch->tile_depth, static_cast<std::int32_t>(pane.tile_columns)};
  FewTiles few_tiles;
  const bool few = compares && readFewTiles(pane, seen, few_tiles);
  const std::uint32_t triangle_count = cluster.triangle_count;
  const std::uint8_t* block = state.facts.pack->triangles +
                              static_cast<std::size_t>(cluster.first_triangle) * kTriangleRows;
  for (std::uint32_t t = 0; t < triangle_count; t += kLanes) {
    const CornerLanes corners =
        cornersAt(block, t + kWidth < triangle_count ? kTriangleRows * kWidth : 0);
    block += kTriangleRows * kLanes;
    unsigned valid = firstLanes(triangle_count - t);
    const IntLanes both = packed(corners);
    if (state.any_bad) {
      const ClipSorting clip = sortForClipping(state, corners);
      append(survivors.clipped, survivors.clipped_count, both, clip.cut & valid);
      valid &= clip.whole;
    }
    const Sorting sorting = sortVector(limits, state, corners);
    unsigned small = sorting.small & valid;
    if (small != 0 && compares) {
      small &= ~(few ? behindTiles(few_tiles, state, sorting, corners)
                     : behindTiles(tiles, state, sorting, corners));
    }
    append(survivors.small, survivors.small_count, both, small);
    const unsigned large = sorting.large & valid;
    if (large != 0) append(survivors.large, survivors.large_count, both, large);
  }
  store(survivors.small + survivors.small_count, spread(0));
  store(survivors.large + survivors.large_count, spread(0));
}

}  // namespace
}  // namespace galactic::render
