// Records of a vector of triangles; the alpha test.
namespace galactic::render {
namespace {

/// A vector of records, made before it is known which of them are needed.
struct alignas(64) GroupRecords {
  float records[kLanes][kRecordStride];
  float colors[kLanes][kRecordStride];
};

/// Makes the records of a group of small triangles.
void makeRecords(ClusterState& state, const SmallGroup& group, GroupRecords& records) {
  Lanes fields[kWidth] = {};
  if (state.facts.isTextured()) readCoordinates(state);
  texturePlanes(state, group, fields);
  storeTransposed(fields, records.records[0], kRecordStride);
  Lanes more[kWidth];
  surfacePlanes(state, group, more);
  storeTransposed(more, records.records[0] + kTexels, kRecordStride);
  if (state.facts.color_kind != kHasColors) return;
  // Sixteen vectors, of which the last four stay 0.
  Lanes colors[2 * kWidth] = {};
  colorPlanes(state, group, colors);
  storeTransposed(colors, records.colors[0], kRecordStride);
  storeTransposed(colors + kWidth, records.colors[0] + kWidth, kRecordStride);
}

/// Copies the records of the triangles in `seen` to the next free places, from `number` on.
void keepRecords(const Pane& pane, const ClusterState& state, const GroupRecords& records,
                 unsigned seen, std::uint32_t number) {
  constexpr std::size_t kBytes = sizeof(float) * kRecordStride;
  for (; seen != 0; seen &= seen - 1, ++number) {
    const int n = __builtin_ctz(seen);
    __builtin_memcpy(recordAt(pane, number), records.records[n], kBytes);
    if (state.facts.color_kind != kHasColors) continue;
    __builtin_memcpy(colorsAt(pane, number), records.colors[n], kBytes);
  }
}

/// Passes the pixels where the surface of the triangle with this record has no hole.
struct AlphaTest {
  static constexpr bool kTests = true;
  const Pane* pane;
  OneRecord record, colors;
  std::int32_t least_alpha;

  /// Returns a vector with the sign set for pixels that pass.
  [[gnu::noinline]] IntLanes operator()(const BlockPlace& place, Lanes z) const {
    const auto vector = static_cast<std::uint32_t>((place.depth - pane->scratch->depth) / kLanes);
    const PixelLanes pixels =
        pixelsOf(vector % pane->columns, vector / pane->columns * kBlocks, spread(1.0F) / z);
    return alphaPasses(*pane->task, record, colors, least_alpha, pixels);
  }
};

inline AlphaTest alphaTest(const Pane& pane, const ClusterState& state, const float* record,
                           const float* colors) {
  return {&pane, {record}, {colors}, static_cast<std::int32_t>(state.facts.surface.least_alpha)};
}

}  // namespace
}  // namespace galactic::render
