// Records: what shading has to know of a triangle that is seen.
namespace galactic::render {
namespace {

inline float* recordsOf(const Pane& pane, std::uint32_t group) {
  return pane.scratch->records + static_cast<std::size_t>(group) * kRecordRows * kWidth;
}
inline float* colorsOf(const Pane& pane, std::uint32_t group) {
  return pane.scratch->colors + static_cast<std::size_t>(group) * kColorRows * kWidth;
}

/// The plane of eight values, by three rows from `rows` on.
inline void storePlane(float* rows, const SmallGroup& group, Lanes a, Lanes b, Lanes c) {
  const GradientLanes change = gradient(group, a, b, c);
  const Lanes per_subpixel = spread(1.0F / kSubpixels);
  const Lanes dx = toFloat(spread(kSubpixels / 2) - group.a.x) * per_subpixel;
  const Lanes dy = toFloat(spread(kSubpixels / 2) - group.a.y) * per_subpixel;
  store(rows, change.right);
  store(rows + kWidth, change.down);
  store(rows + 2 * kWidth, a + (change.right * dx + change.down * dy));
}

inline void storeSurface(const ClusterState& state, float* record) {
  auto kind = static_cast<std::int32_t>(state.surface.kind);
  if (state.pack->colors != nullptr) kind |= static_cast<std::int32_t>(kHasColors);
  store(record + kTexels * kWidth, spread(static_cast<std::int32_t>(state.surface.texels)));
  store(record + kKind * kWidth, spread(kind));
  store(record + kSemantic * kWidth, spread(static_cast<std::int32_t>(state.semantic)));
}

void recordColors(const Pane& pane, const ClusterState& state, const SmallGroup& group) {
  const std::int32_t* colors =
      reinterpret_cast<const std::int32_t*>(state.pack->colors) + state.cluster->first_vertex;
  const IntLanes a = gather(colors, group.corners.a);
  const IntLanes b = gather(colors, group.corners.b);
  const IntLanes c = gather(colors, group.corners.c);
  float* rows = colorsOf(pane, pane.groups);
  for (int channel = 0; channel < 4; ++channel, rows += std::size_t{3} * kWidth) {
    const auto value = [&](IntLanes color) { return toFloat((color >> (8 * channel)) & 0xFF); };
    storePlane(rows, group, value(a) * group.z_a, value(b) * group.z_b, value(c) * group.z_c);
  }
}

/// The records of a group of small triangles, at the number pane.groups.
void recordGroup(const Pane& pane, ClusterState& state, const SmallGroup& group) {
  float* record = recordsOf(pane, pane.groups);
  if ((state.surface.kind & 0xFFU) == kFlatSurface) {
    for (std::uint32_t row = kURight; row <= kVStart; ++row) {
      store(record + std::size_t{row} * kWidth, spread(0.0F));
    }
  } else {
    readCoordinates(state);
    const Pair<Lanes> a = gatherPairs(state.uv, group.corners.a);
    const Pair<Lanes> b = gatherPairs(state.uv, group.corners.b);
    const Pair<Lanes> c = gatherPairs(state.uv, group.corners.c);
    storePlane(record + kURight * kWidth, group, a.first * group.z_a, b.first * group.z_b,
               c.first * group.z_c);
    storePlane(record + kVRight * kWidth, group, a.second * group.z_a, b.second * group.z_b,
               c.second * group.z_c);
  }
  store(record + kWRight * kWidth, group.z.right);
  store(record + kWDown * kWidth, group.z.down);
  storeSurface(state, record);
  if (state.pack->colors != nullptr) recordColors(pane, state, group);
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
  OneRecord record, color;
  std::int32_t least_alpha;

  IntLanes operator()(const BlockPlace& place, Lanes z) const {
    const auto block = static_cast<std::uint32_t>((place.depth - pane->scratch->depth) / kWidth);
    const PixelLanes pixels = pixelsOf(block % pane->columns, block / pane->columns, z);
    const TexturePlaces places = texturePlaces(record, pixels);
    IntLanes texels = sampleTexels(*pane->task, places);
    if (places.kind[0] < 0) texels = timesColors(texels, color, pixels);
    return ((texels >> 24) & 0xFF) >= spread(least_alpha);
  }
};

inline AlphaTest alphaTest(const Pane& pane, const ClusterState& state, std::uint32_t group,
                           std::uint32_t lane) {
  return {&pane,
          {recordsOf(pane, group) + lane},
          {colorsOf(pane, group) + lane},
          static_cast<std::int32_t>(state.surface.least_alpha)};
}

}  // namespace
}  // namespace galactic::render
