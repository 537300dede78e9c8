// Records of eight triangles; the alpha test.
namespace galactic::render {
namespace {

/// Eight records before it is known which of them are needed.
struct alignas(64) GroupRecords {
  float records[kWidth][kRecordStride];
  float colors[kWidth][kRecordStride];
};

/// Eight vectors of one number each become eight records' first numbers.
inline void storeTransposed(const Lanes* fields, float* to) {
  Lanes a[kWidth];
  for (std::uint32_t n = 0; n < kWidth; n += 2) {
    a[n] = __builtin_shufflevector(fields[n], fields[n + 1], 0, 8, 1, 9, 4, 12, 5, 13);
    a[n + 1] = __builtin_shufflevector(fields[n], fields[n + 1], 2, 10, 3, 11, 6, 14, 7, 15);
  }
  Lanes b[kWidth];
  for (std::uint32_t n = 0; n < kWidth; n += 4) {
    b[n] = __builtin_shufflevector(a[n], a[n + 2], 0, 1, 8, 9, 4, 5, 12, 13);
    b[n + 1] = __builtin_shufflevector(a[n], a[n + 2], 2, 3, 10, 11, 6, 7, 14, 15);
    b[n + 2] = __builtin_shufflevector(a[n + 1], a[n + 3], 0, 1, 8, 9, 4, 5, 12, 13);
    b[n + 3] = __builtin_shufflevector(a[n + 1], a[n + 3], 2, 3, 10, 11, 6, 7, 14, 15);
  }
  for (std::uint32_t n = 0; n < 4; ++n) {
    store(to + std::size_t{n} * kRecordStride,
          __builtin_shufflevector(b[n], b[n + 4], 0, 1, 2, 3, 8, 9, 10, 11));
    store(to + std::size_t{n + 4} * kRecordStride,
          __builtin_shufflevector(b[n], b[n + 4], 4, 5, 6, 7, 12, 13, 14, 15));
  }
}

/// The records of a group of small triangles.
void makeRecords(ClusterState& state, const SmallGroup& group, GroupRecords& records) {
  Lanes fields[kWidth] = {};
  if (state.facts.isTextured()) readCoordinates(state);
  texturePlanes(state, group, fields);
  storeTransposed(fields, records.records[0]);
  Lanes more[kWidth];
  surfacePlanes(state, group, more);
  storeTransposed(more, records.records[0] + kTexels);
  if (state.facts.color_kind != kHasColors) return;
  // Sixteen, of which the last four stay 0.
  Lanes colors[2 * kWidth] = {};
  colorPlanes(state, group, colors);
  storeTransposed(colors, records.colors[0]);
  storeTransposed(colors + kWidth, records.colors[0] + kWidth);
}

/// Moves the records of triangles that are seen to the next free numbers.
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

/// Passes pixels whose surface is there, of the triangle with this record.
struct AlphaTest {
  static constexpr bool kTests = true;
  const Pane* pane;
  OneRecord record, colors;
  std::int32_t least_alpha;

  IntLanes operator()(const BlockPlace& place, Lanes z) const {
    const auto block = static_cast<std::uint32_t>((place.depth - pane->scratch->depth) / kWidth);
    const PixelLanes pixels =
        pixelsOf(block % pane->columns, block / pane->columns, spread(1.0F) / z);
    return alphaPasses(*pane->task, record, colors, least_alpha, pixels);
  }
};

inline AlphaTest alphaTest(const Pane& pane, const ClusterState& state, const float* record,
                           const float* colors) {
  return {&pane, {record}, {colors}, static_cast<std::int32_t>(state.facts.surface.least_alpha)};
}

}  // namespace
}  // namespace galactic::render
