// Triangles that are set up one by one: large ones, and the remains of clipped ones.
namespace galactic::render {
namespace {

/// A corner of a triangle in the pane.
struct Corner {
  /// In 1/256 pixel.
  std::int32_t x, y;
  /// 1 / w.
  float z;
  /// u and v in texels, the color from 0 to 255.
  float u, v;
  float color[4];
};

/// An edge function over a pane, starting at the center of its first pixel, divided by 256 and
/// rounded down. This does not change its sign.
struct LongEdge {
  std::int64_t start;
  /// Changes per pixel.
  std::int32_t right, down;
  /// The change from the first pixel of a tile to the one with the largest value.
  std::int64_t reach;
  /// The changes from the first pixel of a block to its pixels.
  IntLanes offsets;
};

GALACTIC_EVERYWHERE inline LongEdge longEdge(const Corner& from, const Corner& to) {
  const std::int64_t dx = to.x - from.x;
  const std::int64_t dy = to.y - from.y;
  const bool keeps = dy < 0 || (dy == 0 && dx > 0);
  const std::int64_t center = kSubpixels / 2;
  const std::int64_t value = dx * (center - from.y) - dy * (center - from.x) - (keeps ? 0 : 1);
  LongEdge edge;
  edge.start = value >> 8;
  edge.right = static_cast<std::int32_t>(-dy);
  edge.down = static_cast<std::int32_t>(dx);
  const std::int64_t last = kTileEdge - 1;
  edge.reach = (dy < 0 ? -dy * last : 0) + (dx > 0 ? dx * last : 0);
  edge.offsets = spread(0);
  return edge;
}

/// A value over a pane, starting at the center of its first pixel.
struct Plane {
  double start, right, down;
};

struct LargeTriangle {
  const Corner* corners[3];
  double double_area;
};

GALACTIC_EVERYWHERE inline Plane planeOf(const LargeTriangle& triangle, double a, double b,
                                         double c) {
  const Corner& first = *triangle.corners[0];
  const double ab_x = triangle.corners[1]->x - first.x;
  const double ab_y = triangle.corners[1]->y - first.y;
  const double ac_x = triangle.corners[2]->x - first.x;
  const double ac_y = triangle.corners[2]->y - first.y;
  const double scale = kSubpixels / triangle.double_area;
  const double right = (ac_y * (b - a) - ab_y * (c - a)) * scale;
  const double down = (ab_x * (c - a) - ac_x * (b - a)) * scale;
  const double dx = (kHalfPixel - first.x) * (1.0 / kSubpixels);
  const double dy = (kHalfPixel - first.y) * (1.0 / kSubpixels);
  return {a + (right * dx + down * dy), right, down};
}

GALACTIC_EVERYWHERE inline void recordPlane(float* fields, const Plane& plane) {
  fields[0] = static_cast<float>(plane.right);
  fields[1] = static_cast<float>(plane.down);
  fields[2] = static_cast<float>(plane.start);
}

/// Writes the record of a triangle and, if it has colors, the record of its colors.
template <class State>
GALACTIC_EVERYWHERE inline void recordLarge(const State& state, const LargeTriangle& triangle,
                                            const Plane& depth, float* record, float* colors) {
  const Corner& a = *triangle.corners[0];
  const Corner& b = *triangle.corners[1];
  const Corner& c = *triangle.corners[2];
  const auto over_w = [](float value, const Corner& corner) {
    return static_cast<double>(value) * static_cast<double>(corner.z);
  };
  recordPlane(record + kURight, planeOf(triangle, over_w(a.u, a), over_w(b.u, b), over_w(c.u, c)));
  recordPlane(record + kVRight, planeOf(triangle, over_w(a.v, a), over_w(b.v, b), over_w(c.v, c)));
  record[kWRight] = static_cast<float>(depth.right);
  record[kWDown] = static_cast<float>(depth.down);
  for (std::uint32_t n = kTexels; n < kRecordStride; ++n) record[n] = surfaceField(state.facts, n);
  if (state.facts.color_kind == kHasLight) {
    recordPlane(record + kLightRight, planeOf(triangle, over_w(a.color[0], a),
                                              over_w(b.color[0], b), over_w(c.color[0], c)));
  }
  if (state.facts.color_kind != kHasColors) return;
  for (int n = 0; n < 4; ++n, colors += 3) {
    recordPlane(colors, planeOf(triangle, over_w(a.color[n], a), over_w(b.color[n], b),
                                over_w(c.color[n], c)));
  }
}

/// First and last columns and rows of tiles.
struct TileBox {
  std::int32_t left, right, top, bottom;
};

GALACTIC_EVERYWHERE inline std::int32_t lesserOf(std::int32_t a, std::int32_t b) {
  return a < b ? a : b;
}
GALACTIC_EVERYWHERE inline std::int32_t greaterOf(std::int32_t a, std::int32_t b) {
  return a > b ? a : b;
}
GALACTIC_EVERYWHERE inline float lesserOf(float a, float b) { return a < b ? a : b; }
GALACTIC_EVERYWHERE inline float greaterOf(float a, float b) { return a > b ? a : b; }

/// Tiles with pixels whose centers lie within the bounds of the corners; right < left if there are
/// none.
GALACTIC_EVERYWHERE inline TileBox tilesOf(const PaneTask& task, const LargeTriangle& triangle) {
  const Corner& a = *triangle.corners[0];
  const Corner& b = *triangle.corners[1];
  const Corner& c = *triangle.corners[2];
  const auto first = [](std::int32_t p, std::int32_t q, std::int32_t r) {
    return greaterOf((lesserOf(lesserOf(p, q), r) + kSubpixels / 2 - 1) >> 8, 0);
  };
  const auto last = [](std::int32_t p, std::int32_t q, std::int32_t r, std::uint32_t count) {
    return lesserOf((greaterOf(greaterOf(p, q), r) - kSubpixels / 2) >> 8,
                    static_cast<std::int32_t>(count) - 1);
  };
  const std::int32_t left = first(a.x, b.x, c.x);
  const std::int32_t right = last(a.x, b.x, c.x, task.width);
  const std::int32_t top = first(a.y, b.y, c.y);
  const std::int32_t bottom = last(a.y, b.y, c.y, task.height);
  if (left > right || top > bottom) return {0, -1, 0, -1};
  return {left >> 3, right >> 3, top >> 3, bottom >> 3};
}

/// What drawing a tile of a large triangle needs.
struct LargeSetup {
  LongEdge edges[3];
  Plane depth;
  Lanes z_offsets, z_low, z_high;
  float z_most;
};

/// Makes a triangle of three corners, which go clockwise on the screen if it shows its face.
/// Returns false if it cannot be seen. The corners must outlive it.
GALACTIC_EVERYWHERE inline bool faces(const Corner& a, const Corner& b, const Corner& c,
                                      bool two_sided, LargeTriangle& triangle) {
  const std::int64_t area = static_cast<std::int64_t>(b.x - a.x) * (c.y - a.y) -
                            static_cast<std::int64_t>(c.x - a.x) * (b.y - a.y);
  if (area == 0 || (area < 0 && !two_sided)) return false;
  triangle = {{&a, area < 0 ? &c : &b, area < 0 ? &b : &c},
              static_cast<double>(area < 0 ? -area : area)};
  return true;
}

GALACTIC_EVERYWHERE inline Plane depthOf(const LargeTriangle& triangle) {
  return planeOf(triangle, static_cast<double>(triangle.corners[0]->z),
                 static_cast<double>(triangle.corners[1]->z),
                 static_cast<double>(triangle.corners[2]->z));
}

/// Sets all members but the offsets, which depend on the pixels of a vector.
GALACTIC_EVERYWHERE inline LargeSetup setUpLarge(const LargeTriangle& triangle) {
  const Corner& a = *triangle.corners[0];
  const Corner& b = *triangle.corners[1];
  const Corner& c = *triangle.corners[2];
  LargeSetup setup;
  setup.edges[0] = longEdge(a, b);
  setup.edges[1] = longEdge(b, c);
  setup.edges[2] = longEdge(c, a);
  setup.depth = depthOf(triangle);
  setup.z_offsets = spread(0.0F);
  setup.z_most = greaterOf(greaterOf(a.z, b.z), c.z);
  setup.z_low = spread(lesserOf(lesserOf(a.z, b.z), c.z));
  setup.z_high = spread(setup.z_most);
  return setup;
}

}  // namespace
}  // namespace galactic::render
