// Records: what shading has to know of a triangle that is seen.
namespace galactic::render {
namespace {

inline float* recordAt(const Pane& pane, std::uint32_t number) {
  return pane.scratch->records + std::size_t{number} * kRecordStride;
}
inline float* colorsAt(const Pane& pane, std::uint32_t number) {
  return pane.scratch->colors + std::size_t{number} * kRecordStride;
}

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

/// The plane of eight values, to three vectors.
inline void planeFields(const SmallGroup& group, Lanes a, Lanes b, Lanes c, Lanes* fields) {
  const GradientLanes change = gradient(group, a, b, c);
  const Lanes per_subpixel = spread(1.0F / kSubpixels);
  const Lanes dx = toFloat(spread(kSubpixels / 2) - group.a.x) * per_subpixel;
  const Lanes dy = toFloat(spread(kSubpixels / 2) - group.a.y) * per_subpixel;
  fields[0] = change.right;
  fields[1] = change.down;
  fields[2] = a + (change.right * dx + change.down * dy);
}

inline std::uint32_t kindOf(const ClusterState& state) {
  return state.surface.kind | state.color_kind;
}

/// The fields from kTexels on.
inline Quad surfaceFields(const ClusterState& state) {
  return Quad{as<float>(state.surface.texels), as<float>(kindOf(state)), as<float>(state.semantic),
              0};
}

void makeColors(const ClusterState& state, const SmallGroup& group, GroupRecords& records) {
  const std::int32_t* colors =
      reinterpret_cast<const std::int32_t*>(state.pack->colors) + state.cluster->first_vertex;
  const IntLanes a = gather(colors, group.corners.a);
  const IntLanes b = gather(colors, group.corners.b);
  const IntLanes c = gather(colors, group.corners.c);
  // Sixteen, of which the last four stay 0.
  Lanes fields[2 * kWidth] = {};
  for (int channel = 0; channel < 4; ++channel) {
    const auto value = [&](IntLanes color) { return toFloat((color >> (8 * channel)) & 0xFF); };
    planeFields(group, value(a) * group.z_a, value(b) * group.z_b, value(c) * group.z_c,
                fields + std::size_t{3} * static_cast<std::uint32_t>(channel));
  }
  storeTransposed(fields, records.colors[0]);
  storeTransposed(fields + kWidth, records.colors[0] + kWidth);
}

/// The plane of the light, from the red of the colors.
inline void makeLight(const ClusterState& state, const SmallGroup& group, Lanes* fields) {
  const std::int32_t* colors =
      reinterpret_cast<const std::int32_t*>(state.pack->colors) + state.cluster->first_vertex;
  const auto light = [&](IntLanes corner) { return toFloat(gather(colors, corner) & 0xFF); };
  planeFields(group, light(group.corners.a) * group.z_a, light(group.corners.b) * group.z_b,
              light(group.corners.c) * group.z_c, fields);
}

/// The records of a group of small triangles.
void makeRecords(ClusterState& state, const SmallGroup& group, GroupRecords& records) {
  Lanes fields[kWidth] = {};
  if ((state.surface.kind & 0xFFU) != kFlatSurface) {
    readCoordinates(state);
    const Pair<Lanes> a = gatherPairs(state.uv, group.corners.a);
    const Pair<Lanes> b = gatherPairs(state.uv, group.corners.b);
    const Pair<Lanes> c = gatherPairs(state.uv, group.corners.c);
    planeFields(group, a.first * group.z_a, b.first * group.z_b, c.first * group.z_c,
                fields + kURight);
    planeFields(group, a.second * group.z_a, b.second * group.z_b, c.second * group.z_c,
                fields + kVRight);
  }
  fields[kWRight] = group.z.right;
  fields[kWDown] = group.z.down;
  storeTransposed(fields, records.records[0]);
  Lanes more[kWidth] = {};
  const Quad surface = surfaceFields(state);
  for (int n = 0; n < 4; ++n) more[n] = spread(surface[n]);
  if (state.color_kind == kHasLight) makeLight(state, group, more + (kLightRight - kTexels));
  storeTransposed(more, records.records[0] + kTexels);
  if (state.color_kind == kHasColors) makeColors(state, group, records);
}

/// Moves the records of triangles that are seen to the next free numbers.
void keepRecords(const Pane& pane, const ClusterState& state, const GroupRecords& records,
                 unsigned seen, std::uint32_t number) {
  constexpr std::size_t kBytes = sizeof(float) * kRecordStride;
  for (; seen != 0; seen &= seen - 1, ++number) {
    const int n = __builtin_ctz(seen);
    __builtin_memcpy(recordAt(pane, number), records.records[n], kBytes);
    if (state.color_kind != kHasColors) continue;
    __builtin_memcpy(colorsAt(pane, number), records.colors[n], kBytes);
  }
}

/// The pixels of a block.
inline PixelLanes pixelsOf(std::uint32_t column, std::uint32_t row, Lanes z) {
  const auto x = static_cast<float>(column * kBlockWidth);
  const auto y = static_cast<float>(row * kBlockHeight);
  return {spread(x) + toFloat(laneRight()), spread(y) + toFloat(laneDown()), z};
}

/// Passes pixels whose surface is there, of the triangle with this record.
struct AlphaTest {
  static constexpr bool kTests = true;
  const Pane* pane;
  OneRecord record, colors;
  std::int32_t least_alpha;

  IntLanes operator()(const BlockPlace& place, Lanes z) const {
    const auto block = static_cast<std::uint32_t>((place.depth - pane->scratch->depth) / kWidth);
    const PixelLanes pixels = pixelsOf(block % pane->columns, block / pane->columns, z);
    const TexturePlaces places = texturePlaces(record, pixels);
    IntLanes texels = sampleTexels(*pane->task, places);
    if (places.kind[0] < 0) texels = timesColors(texels, colors, pixels);
    return ((texels >> 24) & 0xFF) >= spread(least_alpha);
  }
};

inline AlphaTest alphaTest(const Pane& pane, const ClusterState& state, const float* record,
                           const float* colors) {
  return {&pane, {record}, {colors}, static_cast<std::int32_t>(state.surface.least_alpha)};
}

}  // namespace
}  // namespace galactic::render
