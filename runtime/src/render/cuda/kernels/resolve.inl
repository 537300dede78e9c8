// From what is seen at each pixel to the images. What shading has to know of a triangle is computed
// again for each pixel: that takes less time than to keep it.
namespace galactic::render::cuda {
namespace {

/// One triangle of a cluster: what ClusterState has of its three corners.
struct TriangleState {
  std::int32_t xy[6];
  float z[3];
  float uv[6];
  std::int32_t bad[3];
  std::int32_t colors[3];
  std::uint32_t numbers[3];
  ClusterFacts facts;
  const VertexFrame* frame;

  GALACTIC_EVERYWHERE std::uint32_t vertex(std::uint32_t number) const { return numbers[number]; }
};

GALACTIC_EVERYWHERE inline void readTriangle(const VertexFrame& frame, std::uint32_t number,
                                             TriangleState& state) {
  const CornerLanes corners = triangleCorners(state.facts, number);
  state.frame = &frame;
  state.numbers[0] = static_cast<std::uint32_t>(corners.a.v);
  state.numbers[1] = static_cast<std::uint32_t>(corners.b.v);
  state.numbers[2] = static_cast<std::uint32_t>(corners.c.v);
  const std::int32_t* colors = clusterColors(state.facts);
  for (std::uint32_t n = 0; n < 3; ++n) {
    const std::uint32_t vertex = state.numbers[n];
    const std::uint16_t* rows = vertexBlock(state.facts, vertex) + vertex % kWidth;
    placeEight(frame, *state.facts.cluster, rows, n, state);
    if (state.facts.isTextured()) readEight(rows, n, state);
    state.colors[n] = colors == nullptr ? 0 : colors[vertex];
  }
}

struct PixelRecord {
  float record[kRecordStride];
  float colors[kRecordStride];
};

/// The records of the triangle that piece `piece` of a cluster is.
GALACTIC_EVERYWHERE inline void recordPiece(const PaneTask& task, const TriangleState& state,
                                            std::uint32_t piece, PixelRecord& to) {
  if (piece < kFirstLarge) {
    SmallGroup group;
    GroupSetup setup;
    setUpGroup(task, state, packed({0, 1, 2}), group, setup);
    return recordSmall(state, group, to.record, to.colors);
  }
  Corner corners[kMostCorners];
  std::uint32_t second = 1;
  if (piece < kFirstCut) {
    for (std::uint32_t n = 0; n < 3; ++n) corners[n] = cornerOf(state, n);
  } else {
    clipTriangle(state, 0, 1, 2, corners);
    second = 1 + (piece - kFirstCut) % kMostInFan;
  }
  LargeTriangle triangle;
  if (!faces(corners[0], corners[second], corners[second + 1], true, triangle)) return;
  recordLarge(state, triangle, depthOf(triangle), to.record, to.colors);
}

GALACTIC_EVERYWHERE inline std::uint32_t triangleOf(std::uint32_t piece) {
  if (piece < kFirstLarge) return piece;
  return piece < kFirstCut ? piece - kFirstLarge : (piece - kFirstCut) / kMostInFan;
}

GALACTIC_EVERYWHERE inline IntLanes shadePixel(const PaneTask& task, const PixelRecord& from,
                                               const PixelLanes& pixel) {
  const TexturePlaces places = texturePlaces(OneRecord{from.record}, pixel);
  IntLanes color = sampleTexels(task, places);
  if (signBits(places.kind) != 0) color = timesColors(color, OneRecord{from.colors}, pixel);
  if (signBits(places.kind << 1) != 0) {
    const Lanes light[3] = {Lanes(from.record[kLightRight]), Lanes(from.record[kLightDown]),
                            Lanes(from.record[kLightStart])};
    color = timesLight(color, light, pixel);
  }
  // What is drawn hides all behind it.
  return color | static_cast<std::int32_t>(0xFF000000U);
}

/// What images show of a pixel.
struct PixelImage {
  std::uint32_t color;
  std::uint32_t semantic;
};

GALACTIC_EVERYWHERE inline PixelImage lookAtPixel(const PaneLists& lists, std::uint64_t seen,
                                                  std::uint32_t x, std::uint32_t y) {
  const PaneTask& task = *lists.task;
  const std::uint32_t order = ~static_cast<std::uint32_t>(seen);
  const std::uint32_t piece = order & ((1U << kPieceBits) - 1);
  const SeenCluster& cluster = lists.seen[lists.order[order >> kPieceBits]];
  const PlacedModel& placed = task.models[cluster.model];
  TriangleState state;
  state.facts = clusterFacts(*placed.model, cluster.cluster);
  PixelImage image{0, state.facts.semantic};
  if (task.color == nullptr) return image;
  const VertexFrame frame = vertexFrame(task, placed);
  readTriangle(frame, triangleOf(piece), state);
  PixelRecord record{};
  recordPiece(task, state, piece, record);
  const PixelLanes pixel{Lanes(static_cast<float>(x)), Lanes(static_cast<float>(y)),
                         Lanes(1.0F / depthOfSeen(seen))};
  image.color = static_cast<std::uint32_t>(shadePixel(task, record, pixel).v);
  return image;
}

GALACTIC_EVERYWHERE inline void writePixel(const PaneTask& task, std::size_t pixel,
                                           const PixelImage& image) {
  if (task.semantics != nullptr) task.semantics[pixel] = image.semantic;
  if (task.color == nullptr) return;
  std::uint8_t* to = task.color + pixel * task.channels;
  if (task.channels == 4) {
    store(to, IntLanes(static_cast<std::int32_t>(image.color)));
    return;
  }
  for (std::uint32_t n = 0; n < 3; ++n) to[n] = static_cast<std::uint8_t>(image.color >> (8 * n));
}

/// Writes the pixels of a pane that are the block's: `blocks_of_pane` share it.
GALACTIC_EVERYWHERE inline void resolvePane(const Block& block, const ViewSlice& slice,
                                            std::uint32_t blocks_of_pane) {
  const std::uint32_t pane = block.index / blocks_of_pane;
  const PaneLists lists = paneLists(slice, pane);
  const PaneTask& task = *lists.task;
  const std::uint64_t* pixels =
      slice.pixels + static_cast<std::size_t>(pane) * slice.pixels_of_pane;
  const std::uint32_t columns = (task.width + kTileEdge - 1) / kTileEdge * 2;
  block.each([&](std::uint32_t thread) {
    const std::uint32_t first = block.index % blocks_of_pane * block.threads + thread;
    for (std::uint32_t n = first; n < slice.pixels_of_pane; n += blocks_of_pane * block.threads) {
      const std::uint32_t lane = n % kWidth;
      const std::uint32_t x = n / kWidth % columns * kBlockWidth + lane % kBlockWidth;
      const std::uint32_t y = n / kWidth / columns * kBlockHeight + lane / kBlockWidth;
      if (x >= task.width || y >= task.height) continue;
      const std::size_t at =
          static_cast<std::size_t>(task.top + y) * task.image_width + task.left + x;
      const std::uint64_t seen = pixels[n];
      const float z = depthOfSeen(seen);
      if (task.depth != nullptr) task.depth[at] = z > 0 ? 1.0F / z : 0.0F;
      PixelImage image{task.background, 0};
      if (z > 0) image = lookAtPixel(lists, seen, x, y);
      writePixel(task, at, image);
    }
  });
}

}  // namespace
}  // namespace galactic::render::cuda
