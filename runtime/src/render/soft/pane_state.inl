// The state of a pane while it is drawn, which drawing and resolving share.
namespace galactic::render {
namespace {

struct Pane {
  const PaneTask* task;
  const PaneScratch* scratch;
  /// Size of the pane in whole blocks and in whole tiles.
  std::uint32_t columns, rows, tile_columns;
  /// Records in use.
  std::uint32_t records;
  PaneCounts counts;
  bool shades;
  /// Whether some pixels have already been shaded.
  bool has_shaded;
};

/// A pane on which nothing is drawn yet; record 0 is the background's.
inline Pane newPane(const PaneTask& task, const PaneScratch& scratch) {
  const std::uint32_t tiles_across = (task.width + kTileEdge - 1) / kTileEdge;
  const std::uint32_t tiles_down = (task.height + kTileEdge - 1) / kTileEdge;
  return {.task = &task,
          .scratch = &scratch,
          .columns = tiles_across * (kTileEdge / kBlockWidth),
          .rows = tiles_down * (kTileEdge / kBlockHeight),
          .tile_columns = tiles_across,
          .records = 1,
          .counts = {},
          .shades = task.color != nullptr || task.semantics != nullptr,
          .has_shaded = false};
}

/// What pixels store for a record: the index of its first number.
inline IntLanes idOf(std::uint32_t number) {
  return spread(static_cast<std::int32_t>(number * kRecordStride));
}

inline float* recordAt(const Pane& pane, std::uint32_t number) {
  return pane.scratch->records + std::size_t{number} * kRecordStride;
}
inline float* colorsAt(const Pane& pane, std::uint32_t number) {
  return pane.scratch->colors + std::size_t{number} * kRecordStride;
}

/// Rows of pixels in a vector.
constexpr std::uint32_t kHigh = kBlocks * kBlockHeight;

/// Where the data of a vector of pixels lies.
struct BlockPlace {
  float* depth;
  std::int32_t* ids;
};

/// `row`: the row of the vector's first block.
inline BlockPlace placeOf(const Pane& pane, std::uint32_t column, std::uint32_t row) {
  const std::size_t at = (std::size_t{row / kBlocks} * pane.columns + column) * kLanes;
  return {pane.scratch->depth + at, pane.scratch->ids + at};
}

/// From one row of vectors to the next.
inline std::size_t rowStride(const Pane& pane) { return std::size_t{pane.columns} * kLanes; }

/// How far each pixel of a vector is from the first one, to the right and down.
inline IntLanes pixelsRight() {
  constexpr std::int32_t kRight[16] = {0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3};
  return load<IntLanes>(kRight);
}
inline IntLanes pixelsDown() {
  constexpr std::int32_t kDown[16] = {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3};
  return load<IntLanes>(kDown);
}

/// 0, 1, 2 and so on.
inline IntLanes laneNumbers() {
  constexpr std::int32_t kNumbers[16] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
  return load<IntLanes>(kNumbers);
}

/// The first `count` lanes, or all if there are fewer: bit n for lane n.
inline unsigned firstLanes(std::uint32_t count) {
  return count < kLanes ? (1U << count) - 1 : kAllLanes;
}

/// The pixels of a vector that begins at a block.
inline PixelLanes pixelsOf(std::uint32_t column, std::uint32_t row, Lanes w) {
  const auto x = static_cast<float>(column * kBlockWidth);
  const auto y = static_cast<float>(row * kBlockHeight);
  return {spread(x) + toFloat(pixelsRight()), spread(y) + toFloat(pixelsDown()), w};
}

}  // namespace
}  // namespace galactic::render
