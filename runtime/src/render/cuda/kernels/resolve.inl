// Computes the images from what is visible at each pixel. A block writes a square of pixels: it
// lists the triangles that are visible there, computes the record of each once, and shades the
// pixels.
namespace galactic::render::cuda {
namespace {

/// One triangle of a cluster: what ClusterState has for all vertices, for its three corners.
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
    placeVector(frame, *state.facts.cluster, {rows}, n, state);
    if (state.facts.isTextured()) readVector({rows}, n, state);
    state.colors[n] = colors == nullptr ? 0 : colors[vertex];
  }
}

struct PixelRecord {
  float record[kRecordStride];
  float colors[kRecordStride];
};

/// Writes the records of piece `piece` of a cluster.
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

GALACTIC_EVERYWHERE inline IntLanes shadePixel(const PaneTask& task, const float* record,
                                               const float* colors, const PixelLanes& pixel) {
  IntLanes color = sampleOne(task, OneRecord{record}, pixel);
  const auto kind = as<std::uint32_t>(record[kKind]);
  if ((kind & kHasColors) != 0) color = timesColors(color, OneRecord{colors}, pixel);
  if ((kind & kHasLight) != 0) {
    const Lanes light[3] = {Lanes(record[kLightRight]), Lanes(record[kLightDown]),
                            Lanes(record[kLightStart])};
    color = timesLight(color, lightAt(light, pixel));
  }
  // Whatever is drawn is opaque: its alpha is 255.
  return color | static_cast<std::int32_t>(0xFF000000U);
}

/// What images show at a pixel.
struct PixelImage {
  std::uint32_t color;
  std::uint32_t semantic;
};

/// The triangle in a number of seenAt(): its rank and its piece.
GALACTIC_EVERYWHERE inline std::uint32_t orderOfSeen(std::uint64_t seen) {
  return ~static_cast<std::uint32_t>(seen);
}

/// Writes the records of the triangle with this `order` on a pane.
GALACTIC_EVERYWHERE inline void recordSeen(const PaneLists& lists, std::uint32_t order,
                                           PixelRecord& to) {
  const PaneTask& task = *lists.task;
  const std::uint32_t piece = order & ((1U << kPieceBits) - 1);
  const SeenCluster& cluster = lists.seen[lists.order[order >> kPieceBits]];
  const PlacedModel& placed = task.models[cluster.model];
  TriangleState state;
  state.facts = clusterFacts(placed, cluster.cluster);
  const VertexFrame frame = vertexFrame(task, placed);
  readTriangle(frame, triangleOf(piece), state);
  recordPiece(task, state, piece, to);
}

/// The semantic id of the triangle with this `order`.
GALACTIC_EVERYWHERE inline std::uint32_t semanticSeen(const PaneLists& lists, std::uint32_t order) {
  const SeenCluster& cluster = lists.seen[lists.order[order >> kPieceBits]];
  return clusterFacts(lists.task->models[cluster.model], cluster.cluster).semantic;
}

constexpr std::uint32_t kSquarePixels = kResolveEdge * kResolveEdge;
/// Slots of a hash table, twice as many as there can be triangles, so that searches are short.
constexpr std::uint32_t kSlots = 2 * kSquarePixels;
constexpr std::uint32_t kEmptySlot = 0xFFFFFFFF;
/// How many triangles have their records kept; those of the others are computed for each pixel.
constexpr std::uint32_t kKeptRecords = 128;

struct ResolveShared {
  /// By slot: the order of a triangle, and its place in the list.
  std::uint32_t orders[kSlots];
  std::uint16_t places[kSlots];
  /// By pixel: the slot of its triangle.
  std::uint16_t slots[kSquarePixels];
  std::uint32_t count;
  std::uint32_t list[kKeptRecords];
  float records[kKeptRecords][kRecordStride];
};

/// The slot of a triangle. Lists the triangle if it is new.
GALACTIC_EVERYWHERE inline std::uint32_t listTriangle(ResolveShared& shared, std::uint32_t order) {
  std::uint32_t slot = (order * 2654435761U) >> 23U;
  static_assert(kSlots == 1U << 9U);
  while (true) {
    const std::uint32_t before = claimAtomically(shared.orders + slot, kEmptySlot, order);
    if (before == order) return slot;
    if (before == kEmptySlot) break;
    slot = (slot + 1) % kSlots;
  }
  const std::uint32_t place = addAtomically(&shared.count, 1U);
  shared.places[slot] = static_cast<std::uint16_t>(place);
  if (place < kKeptRecords) shared.list[place] = order;
  return slot;
}

/// A pixel of a square: where it lies in the pane, and in the pane's list of pixels.
struct SquarePixel {
  std::uint32_t x, y;
  std::size_t at;
};

GALACTIC_EVERYWHERE inline SquarePixel squarePixel(const PaneTask& task, std::uint32_t square,
                                                   std::uint32_t number) {
  constexpr std::uint32_t kAcross = kResolveEdge / kBlockWidth;
  const std::uint32_t squares = (task.width + kResolveEdge - 1) / kResolveEdge;
  const std::uint32_t columns = (task.width + kTileEdge - 1) / kTileEdge * 2;
  const std::uint32_t lane = number % kWidth;
  const std::uint32_t block = number / kWidth;
  const std::uint32_t column = square % squares * kAcross + block % kAcross;
  const std::uint32_t row = square / squares * (kResolveEdge / kBlockHeight) + block / kAcross;
  return {column * kBlockWidth + lane % kBlockWidth, row * kBlockHeight + lane / kBlockWidth,
          (static_cast<std::size_t>(row) * columns + column) * kWidth + lane};
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

/// The color and the semantic id of a pixel. `shared` has the triangles of its square.
GALACTIC_EVERYWHERE inline PixelImage lookAtPixel(const PaneLists& lists,
                                                  const ResolveShared& shared, std::uint32_t number,
                                                  const SquarePixel& place, std::uint64_t seen) {
  const PaneTask& task = *lists.task;
  const std::uint32_t order = orderOfSeen(seen);
  if (task.color == nullptr) return {0, semanticSeen(lists, order)};
  const std::uint32_t kept =
      order == kEmptySlot ? kKeptRecords : shared.places[shared.slots[number]];
  const PixelLanes pixel{Lanes(static_cast<float>(place.x)), Lanes(static_cast<float>(place.y)),
                         Lanes(1.0F / depthOfSeen(seen))};
  if (kept < kKeptRecords) {
    const float* record = shared.records[kept];
    if ((as<std::uint32_t>(record[kKind]) & kHasColors) == 0) {
      // The second record is not read, since the triangle has no colors.
      return {static_cast<std::uint32_t>(shadePixel(task, record, record, pixel).v),
              as<std::uint32_t>(record[kSemantic])};
    }
  }
  PixelRecord own{};
  recordSeen(lists, order, own);
  return {static_cast<std::uint32_t>(shadePixel(task, own.record, own.colors, pixel).v),
          as<std::uint32_t>(own.record[kSemantic])};
}

/// Lists the triangles that are visible in a square, and computes their records.
GALACTIC_EVERYWHERE inline void recordSquare(const Block& block, const PaneLists& lists,
                                             const std::uint64_t* pixels, std::uint32_t square,
                                             ResolveShared& shared) {
  const PaneTask& task = *lists.task;
  block.each([&](std::uint32_t thread) {
    for (std::uint32_t n = thread; n < kSlots; n += block.threads) shared.orders[n] = kEmptySlot;
    if (thread == 0) shared.count = 0;
  });
  block.each([&](std::uint32_t thread) {
    for (std::uint32_t n = thread; n < kSquarePixels; n += block.threads) {
      const SquarePixel place = squarePixel(task, square, n);
      if (place.x >= task.width || place.y >= task.height) continue;
      const std::uint64_t seen = pixels[place.at];
      if (!(depthOfSeen(seen) > 0) || orderOfSeen(seen) == kEmptySlot) continue;
      shared.slots[n] = static_cast<std::uint16_t>(listTriangle(shared, orderOfSeen(seen)));
    }
  });
  block.each([&](std::uint32_t thread) {
    for (std::uint32_t n = thread; n < kKeptRecords && n < shared.count; n += block.threads) {
      PixelRecord own{};
      recordSeen(lists, shared.list[n], own);
      for (std::uint32_t f = 0; f < kRecordStride; ++f) shared.records[n][f] = own.record[f];
    }
  });
}

/// Writes the block's square of a pane, which `blocks_of_pane` blocks share.
GALACTIC_EVERYWHERE inline void resolvePane(const Block& block, ResolveShared& shared,
                                            const ViewSlice& slice, std::uint32_t blocks_of_pane) {
  const std::uint32_t pane = block.index / blocks_of_pane;
  const std::uint32_t square = block.index % blocks_of_pane;
  const PaneLists lists = paneLists(slice, pane);
  const PaneTask& task = *lists.task;
  const std::uint64_t* pixels =
      slice.pixels + static_cast<std::size_t>(pane) * slice.pixels_of_pane;
  if (task.color != nullptr) recordSquare(block, lists, pixels, square, shared);
  block.each([&](std::uint32_t thread) {
    for (std::uint32_t n = thread; n < kSquarePixels; n += block.threads) {
      const SquarePixel place = squarePixel(task, square, n);
      if (place.x >= task.width || place.y >= task.height) continue;
      const std::size_t at =
          static_cast<std::size_t>(task.top + place.y) * task.image_width + task.left + place.x;
      const std::uint64_t seen = pixels[place.at];
      const float z = depthOfSeen(seen);
      if (task.depth != nullptr) task.depth[at] = z > 0 ? 1.0F / z : 0.0F;
      PixelImage image{task.background, 0};
      if (z > 0) image = lookAtPixel(lists, shared, n, place, seen);
      writePixel(task, at, image);
    }
  });
}

}  // namespace
}  // namespace galactic::render::cuda
