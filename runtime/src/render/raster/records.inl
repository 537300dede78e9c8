// Records of small triangles: what shading has to know about them.
namespace galactic::render {
namespace {

/// Writes the planes of a vector of values to three vectors.
GALACTIC_EVERYWHERE inline void planeFields(const SmallGroup& group, Lanes a, Lanes b, Lanes c,
                                            Lanes* fields) {
  const GradientLanes change = gradient(group, a, b, c);
  const Lanes per_subpixel = spread(1.0F / kSubpixels);
  const Lanes dx = toFloat(spread(kSubpixels / 2) - group.a.x) * per_subpixel;
  const Lanes dy = toFloat(spread(kSubpixels / 2) - group.a.y) * per_subpixel;
  fields[0] = change.right;
  fields[1] = change.down;
  fields[2] = a + (change.right * dx + change.down * dy);
}

/// Field `number` of a record, kTexels or later; 0 for the plane of light.
GALACTIC_EVERYWHERE inline float surfaceField(const ClusterFacts& facts, std::uint32_t number) {
  switch (number) {
    case kTexels:
      return as<float>(facts.surface.texels);
    case kKind:
      return as<float>(facts.surface.kind | facts.color_kind);
    case kSemantic:
      return as<float>(facts.semantic);
    default:
      return 0;
  }
}

/// Writes the fields before kTexels, which must be 0 before. If the surface has a texture, state.uv
/// must be set.
template <class State>
GALACTIC_EVERYWHERE inline void texturePlanes(const State& state, const SmallGroup& group,
                                              Lanes* fields) {
  if (state.facts.isTextured()) {
    const Pair<Lanes> a = lookUpPairs(state.uv, group.corners.a);
    const Pair<Lanes> b = lookUpPairs(state.uv, group.corners.b);
    const Pair<Lanes> c = lookUpPairs(state.uv, group.corners.c);
    planeFields(group, a.first * group.z_a, b.first * group.z_b, c.first * group.z_c,
                fields + kURight);
    planeFields(group, a.second * group.z_a, b.second * group.z_b, c.second * group.z_c,
                fields + kVRight);
  }
  fields[kWRight] = group.z.right;
  fields[kWDown] = group.z.down;
}

/// Writes the fields from kTexels on.
template <class State>
GALACTIC_EVERYWHERE inline void surfacePlanes(const State& state, const SmallGroup& group,
                                              Lanes* fields) {
  for (std::uint32_t n = 0; n < kRecordStride - kTexels; ++n) {
    fields[n] = spread(surfaceField(state.facts, kTexels + n));
  }
  if (state.facts.color_kind != kHasLight) return;
  const auto light = [&](IntLanes corner) { return toFloat(gather(state.colors, corner) & 0xFF); };
  planeFields(group, light(group.corners.a) * group.z_a, light(group.corners.b) * group.z_b,
              light(group.corners.c) * group.z_c, fields + (kLightRight - kTexels));
}

/// Writes the planes of the colors, kColorFields vectors.
template <class State>
GALACTIC_EVERYWHERE inline void colorPlanes(const State& state, const SmallGroup& group,
                                            Lanes* fields) {
  const IntLanes a = gather(state.colors, group.corners.a);
  const IntLanes b = gather(state.colors, group.corners.b);
  const IntLanes c = gather(state.colors, group.corners.c);
  for (int channel = 0; channel < 4; ++channel) {
    const auto value = [&](IntLanes color) { return toFloat((color >> (8 * channel)) & 0xFF); };
    planeFields(group, value(a) * group.z_a, value(b) * group.z_b, value(c) * group.z_c,
                fields + std::size_t{3} * static_cast<std::uint32_t>(channel));
  }
}

}  // namespace
}  // namespace galactic::render
