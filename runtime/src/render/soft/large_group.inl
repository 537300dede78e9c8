// Set-up of a vector of large triangles. The numbers are those of faces(), tilesOf() and
// setUpLarge() for each triangle, bit for bit.
namespace galactic::render {
namespace {

struct LargeGroup {
  /// Corners in the order in which the triangles show their faces.
  alignas(kVectorBytes) std::int32_t corners[kLanes];
  /// First and last columns and rows of tiles.
  alignas(kVectorBytes) std::int32_t left[kLanes], right[kLanes], top[kLanes], bottom[kLanes];
  alignas(kVectorBytes) float z_low[kLanes], z_high[kLanes];
  /// Changes of edge functions per pixel.
  alignas(kVectorBytes) std::int32_t edge_right[3][kLanes], edge_down[3][kLanes];
  alignas(kVectorBytes) double edge_start[3][kLanes];
  alignas(kVectorBytes) double area[kLanes], start[kLanes], z_right[kLanes], z_down[kLanes];
};

/// As many lanes, from `first` on, as a vector has doubles.
template <class Half, class Whole>
inline Half halfOf(const Whole& v, std::uint32_t first) {
  Half half;
  __builtin_memcpy(&half, reinterpret_cast<const char*>(&v) + std::size_t{4} * first, sizeof(half));
  return half;
}
inline Doubles doublesOf(IntLanes v, std::uint32_t first) {
  return __builtin_convertvector(halfOf<HalfInts>(v, first), Doubles);
}
inline Doubles doublesOf(Lanes v, std::uint32_t first) {
  return __builtin_convertvector(halfOf<HalfFloats>(v, first), Doubles);
}

/// Rounds down, for magnitudes below 2^51.
inline Doubles floorOf(Doubles v) {
  constexpr double kToWholeDouble = 6755399441055744.0;
  const Doubles nearest = (v + kToWholeDouble) - kToWholeDouble;
  return nearest > v ? nearest - 1 : nearest;
}

struct LargeCorners {
  PointLanes a, b, c;
  Lanes z_a, z_b, z_c;
};

inline void setUpLongEdge(const PointLanes& from, const PointLanes& to, std::uint32_t e,
                          LargeGroup& group) {
  const IntLanes dx = to.x - from.x;
  const IntLanes dy = to.y - from.y;
  const IntLanes keeps = (dy < spread(0)) | ((dy == spread(0)) & (dx > spread(0)));
  store(group.edge_right[e], -dy);
  store(group.edge_down[e], dx);
  for (std::uint32_t first = 0; first < kLanes; first += kHalf) {
    const Doubles across = doublesOf(spread(kSubpixels / 2) - from.y, first);
    const Doubles along = doublesOf(spread(kSubpixels / 2) - from.x, first);
    // Exact, since coordinates are below 2^24.
    const Doubles value =
        doublesOf(dx, first) * across - doublesOf(dy, first) * along + doublesOf(~keeps, first);
    store(group.edge_start[e] + first, floorOf(value * (1.0 / kSubpixels)));
  }
}

/// See planeOf().
inline void setUpDepth(const LargeCorners& k, LargeGroup& group) {
  for (std::uint32_t first = 0; first < kLanes; first += kHalf) {
    const Doubles a = doublesOf(k.z_a, first);
    const Doubles b_less_a = doublesOf(k.z_b, first) - a;
    const Doubles c_less_a = doublesOf(k.z_c, first) - a;
    const Doubles scale = kSubpixels / load<Doubles>(group.area + first);
    const Doubles right =
        (doublesOf(k.c.y - k.a.y, first) * b_less_a - doublesOf(k.b.y - k.a.y, first) * c_less_a) *
        scale;
    const Doubles down =
        (doublesOf(k.b.x - k.a.x, first) * c_less_a - doublesOf(k.c.x - k.a.x, first) * b_less_a) *
        scale;
    const Doubles dx = doublesOf(spread(kHalfPixel) - k.a.x, first) * (1.0 / kSubpixels);
    const Doubles dy = doublesOf(spread(kHalfPixel) - k.a.y, first) * (1.0 / kSubpixels);
    store(group.start + first, a + (right * dx + down * dy));
    store(group.z_right + first, right);
    store(group.z_down + first, down);
  }
}

/// Signs of the areas. Bit n of `negative`: that of triangle n is below 0; of `none`: it is 0.
struct AreaSigns {
  unsigned negative, none;
};

inline AreaSigns setUpAreas(const LargeCorners& k, LargeGroup& group) {
  AreaSigns signs{0, 0};
  for (std::uint32_t first = 0; first < kLanes; first += kHalf) {
    const Doubles area = doublesOf(k.b.x - k.a.x, first) * doublesOf(k.c.y - k.a.y, first) -
                         doublesOf(k.c.x - k.a.x, first) * doublesOf(k.b.y - k.a.y, first);
    double areas[kHalf];
    store(areas, area);
    for (std::uint32_t n = 0; n < kHalf; ++n) {
      signs.negative |= (areas[n] < 0 ? 1U : 0U) << (first + n);
      signs.none |= (areas[n] == 0 ? 1U : 0U) << (first + n);
    }
    store(group.area + first, area < 0 ? -area : area);
  }
  return signs;
}

/// Sets up the triangles. Returns which of them may be visible: bit n for triangle n.
inline unsigned setUpLargeGroup(const PaneTask& task, const ClusterState& state,
                                IntLanes packed_corners, LargeGroup& group) {
  const CornerLanes numbers = unpacked(packed_corners);
  LargeCorners k{pointsOf(state, numbers.a), pointsOf(state, numbers.b),
                 pointsOf(state, numbers.c), lookUp(state.z, numbers.a),
                 lookUp(state.z, numbers.b), lookUp(state.z, numbers.c)};
  const AreaSigns signs = setUpAreas(k, group);
  const LaneSet back = setOf(signs.negative);
  const LargeCorners seen = k;
  k.b = {pickFrom(back, seen.c.x, seen.b.x), pickFrom(back, seen.c.y, seen.b.y)};
  k.c = {pickFrom(back, seen.b.x, seen.c.x), pickFrom(back, seen.b.y, seen.c.y)};
  k.z_b = pickFrom(back, seen.z_c, seen.z_b);
  k.z_c = pickFrom(back, seen.z_b, seen.z_c);
  store(group.corners, pickFrom(back, packed({numbers.a, numbers.c, numbers.b}), packed_corners));
  const IntLanes left = greater(firstPixel(leastOf(k.a.x, k.b.x, k.c.x)), spread(0));
  const IntLanes top = greater(firstPixel(leastOf(k.a.y, k.b.y, k.c.y)), spread(0));
  const IntLanes right = lesser(lastPixel(mostOf(k.a.x, k.b.x, k.c.x)),
                                spread(static_cast<std::int32_t>(task.width) - 1));
  const IntLanes bottom = lesser(lastPixel(mostOf(k.a.y, k.b.y, k.c.y)),
                                 spread(static_cast<std::int32_t>(task.height) - 1));
  store(group.left, left >> 3);
  store(group.right, right >> 3);
  store(group.top, top >> 3);
  store(group.bottom, bottom >> 3);
  store(group.z_low, leastOf(k.z_a, k.z_b, k.z_c));
  store(group.z_high, mostOf(k.z_a, k.z_b, k.z_c));
  setUpLongEdge(k.a, k.b, 0, group);
  setUpLongEdge(k.b, k.c, 1, group);
  setUpLongEdge(k.c, k.a, 2, group);
  setUpDepth(k, group);
  const unsigned turned_away = state.facts.cluster->two_sided != 0 ? 0 : signs.negative;
  return ~(signBits((right - left) | (bottom - top)) | signs.none | turned_away) & kAllLanes;
}

/// Sets all members but the offsets.
inline LargeSetup setupOf(const LargeGroup& group, std::uint32_t n) {
  LargeSetup setup;
  for (std::uint32_t e = 0; e < 3; ++e) {
    LongEdge& edge = setup.edges[e];
    edge.start = static_cast<std::int64_t>(group.edge_start[e][n]);
    edge.right = group.edge_right[e][n];
    edge.down = group.edge_down[e][n];
  }
  setup.depth = {group.start[n], group.z_right[n], group.z_down[n]};
  setup.z_most = group.z_high[n];
  setup.z_low = spread(group.z_low[n]);
  setup.z_high = spread(group.z_high[n]);
  return setup;
}

inline TileBox tilesOf(const LargeGroup& group, std::uint32_t n) {
  return {group.left[n], group.right[n], group.top[n], group.bottom[n]};
}

}  // namespace
}  // namespace galactic::render
