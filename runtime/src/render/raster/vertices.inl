// Takes vertices of a cluster to the pane.
namespace galactic::render {
namespace {

/// Vertices whose X / w or Y / w is larger than this, in 1/256 pixel, are cut off, so that
/// differences of integer positions stay small. Twice the edge of the largest image.
constexpr float kGuard = 1 << 21;
/// Adding this to a number below 2^22 leaves the nearest whole number in the lowest bits.
constexpr float kToWhole = 12582912.0F;

/// What is the same for all vertices of a model.
struct VertexFrame {
  /// Rows for points on the lattice: they contain the step.
  float w[4], x[4], y[4];
  /// The pane's upper left corner in the image, in 1/256 pixel.
  std::int32_t left, top;
  /// The middle of the image, in 1/256 pixel.
  float middle_x, middle_y;
  float near;
};

GALACTIC_EVERYWHERE inline VertexFrame vertexFrame(const PaneTask& task,
                                                   const PlacedModel& placed) {
  VertexFrame frame;
  const float step = placed.model->step;
  for (int n = 0; n < 4; ++n) {
    // Exact: the step is a power of two.
    const float factor = n < 3 ? step : 1.0F;
    frame.w[n] = placed.w[n] * factor;
    frame.x[n] = placed.x[n] * factor;
    frame.y[n] = placed.y[n] * factor;
  }
  frame.left = static_cast<std::int32_t>(task.left) * kSubpixels;
  frame.top = static_cast<std::int32_t>(task.top) * kSubpixels;
  frame.middle_x = static_cast<float>(task.image_width) * kHalfPixel;
  frame.middle_y = static_cast<float>(task.image_height) * kHalfPixel;
  frame.near = task.near;
  return frame;
}

/// What is the same for all triangles of a cluster.
struct ClusterFacts {
  const PackTables* pack;
  const RenderCluster* cluster;
  SurfaceTexels surface;
  /// kHasColors, kHasLight or 0.
  std::uint32_t color_kind;
  /// The id that images show.
  std::uint32_t semantic;

  GALACTIC_EVERYWHERE bool isTextured() const { return (surface.kind & 0xFFU) != kFlatSurface; }
};

GALACTIC_EVERYWHERE inline ClusterFacts clusterFacts(const PlacedModel& placed,
                                                     std::uint32_t number) {
  const ModelTables& model = *placed.model;
  const PackTables& pack = *model.pack;
  const RenderCluster* cluster = pack.clusters + model.first_cluster + number;
  const std::uint32_t kind =
      pack.color_kinds == nullptr ? 0 : pack.color_kinds[model.first_cluster + number];
  const std::uint32_t semantic = placed.semantic == kSemanticsOfPack
                                     ? pack.first_semantic + cluster->semantic
                                     : placed.semantic;
  return {&pack, cluster, pack.surfaces[cluster->material], kind, semantic};
}

/// The colors of the cluster's vertices; null if color_kind is 0.
GALACTIC_EVERYWHERE inline const std::int32_t* clusterColors(const ClusterFacts& facts) {
  if (facts.color_kind == 0) return nullptr;
  return reinterpret_cast<const std::int32_t*>(facts.pack->colors) + facts.cluster->first_vertex;
}

/// The rows of the block of eight vertices that contains vertex `number`.
GALACTIC_EVERYWHERE inline const std::uint16_t* vertexBlock(const ClusterFacts& facts,
                                                            std::uint32_t number) {
  return facts.pack->vertices +
         static_cast<std::size_t>(facts.cluster->first_vertex + number / kWidth * kWidth) *
             kVertexRows;
}

/// A cluster that is being drawn.
struct ClusterState {
  /// A table of pairs: x and y in the pane, 1/256 pixel from its upper left corner. Meaningless for
  /// `bad` vertices.
  alignas(64) std::int32_t xy[2 * kMostInCluster];
  /// 1 / w.
  alignas(64) float z[kMostInCluster];
  /// A table of pairs: texture coordinates; see readCoordinates().
  alignas(64) float uv[2 * kMostInCluster];
  /// Bit n: the vertex is on the wrong side of clip plane n (see clipDistance()), or of one of the
  /// planes that markBeside() adds.
  alignas(64) std::int32_t bad[kMostInCluster];
  bool any_bad;
  bool has_coordinates;

  ClusterFacts facts;
  const VertexFrame* frame;
  /// Colors of the vertices; only if color_kind is not 0.
  const std::int32_t* colors;

  /// The number in the cluster of the vertex with this number in these arrays.
  GALACTIC_EVERYWHERE std::uint32_t vertex(std::uint32_t number) const { return number; }
};

GALACTIC_EVERYWHERE inline Lanes along(const float* row, Lanes x, Lanes y, Lanes z) {
  return ((spread(row[0]) * x + spread(row[1]) * y) + spread(row[2]) * z) + spread(row[3]);
}

/// The nearest whole number for |value| < 2^22.
GALACTIC_EVERYWHERE inline IntLanes wholeNumber(Lanes value) {
  return as<IntLanes>(value + spread(kToWhole)) - spread(as<std::int32_t>(kToWhole));
}

/// The rows of a vector of vertices: of a block of eight and, if a vector takes two blocks, of the
/// block `next` numbers further.
struct VertexRows {
  const std::uint16_t* block;
  std::size_t next = 0;

  GALACTIC_EVERYWHERE IntLanes row(std::uint32_t number) const {
    return loadRows(block + std::size_t{number} * kWidth, next);
  }
};

/// The rows from vertex `first` on, which is the first of `block`.
GALACTIC_EVERYWHERE inline VertexRows vertexRows(const RenderCluster& cluster,
                                                 const std::uint16_t* block, std::uint32_t first) {
  return {block, first + kWidth < cluster.vertex_count ? kVertexRows * kWidth : 0};
}

/// Vertices before the division by w; see PlacedModel for their numbers.
struct VertexLanes {
  Lanes w, right, down;
};

GALACTIC_EVERYWHERE inline VertexLanes vertexLanes(const VertexFrame& frame,
                                                   const RenderCluster& cluster,
                                                   const VertexRows& rows) {
  const Lanes x = toFloat(rows.row(0) + spread(cluster.origin_x));
  const Lanes y = toFloat(rows.row(1) + spread(cluster.origin_y));
  const Lanes z = toFloat(rows.row(2) + spread(cluster.origin_z));
  return {along(frame.w, x, y, z), along(frame.x, x, y, z), along(frame.y, x, y, z)};
}

/// Places a vector of vertices from `first` on. Returns which of them need no clipping, as bits.
template <class State>
GALACTIC_EVERYWHERE inline unsigned placeVector(const VertexFrame& frame,
                                                const RenderCluster& cluster,
                                                const VertexRows& rows, std::uint32_t first,
                                                State& state) {
  const VertexLanes vertices = vertexLanes(frame, cluster, rows);
  const Lanes w = vertices.w;
  const Lanes right = vertices.right;
  const Lanes down = vertices.down;
  const Lanes guard = spread(kGuard) * w;
  const IntLanes good =
      (w >= spread(frame.near)) & (magnitude(right) <= guard) & (magnitude(down) <= guard);
  const Lanes inverse = spread(1.0F) / w;
  Lanes px = right * inverse + spread(frame.middle_x);
  Lanes py = down * inverse + spread(frame.middle_y);
  const unsigned good_bits = signBits(good);
  IntLanes bad = spread(0);
  if (good_bits != kAllLanes) {
    px = pick(good, px, spread(0.0F));
    py = pick(good, py, spread(0.0F));
    bad = (~(w >= spread(frame.near)) & 1) | (~(right <= guard) & 2) | (~(-right <= guard) & 4) |
          (~(down <= guard) & 8) | (~(-down <= guard) & 16);
  }
  storePairs(state.xy + std::size_t{2} * first, wholeNumber(px) - spread(frame.left),
             wholeNumber(py) - spread(frame.top));
  store(state.z + first, inverse);
  store(state.bad + first, bad);
  return good_bits;
}

/// Reads the texture coordinates of a vector of vertices from `first` on, in texels of the largest
/// level.
template <class State>
GALACTIC_EVERYWHERE inline void readVector(const VertexRows& rows, std::uint32_t first,
                                           State& state) {
  const RenderCluster& cluster = *state.facts.cluster;
  const auto edge = static_cast<float>(1U << (state.facts.surface.kind & 0xFFU));
  const Lanes u = toFloat(rows.row(3));
  const Lanes v = toFloat(rows.row(4));
  storePairs(state.uv + std::size_t{2} * first,
             spread(cluster.u_minimum * edge) + spread(cluster.u_step * edge) * u,
             spread(cluster.v_minimum * edge) + spread(cluster.v_step * edge) * v);
}

}  // namespace
}  // namespace galactic::render
