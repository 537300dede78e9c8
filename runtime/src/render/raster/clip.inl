// Clips triangles that come too near to the eye or reach too far beside the image (Sutherland and
// Hodgman). Two triangles that share an edge cut it from the same end, so their new corners agree.
namespace galactic::render {
namespace {

/// A corner before the division by w; see PlacedModel for its numbers.
struct ClipVertex {
  float w, x, y;
  float u, v;
  float color[4];
};

constexpr int kClipPlanes = 5;
/// Each plane adds at most one corner to a triangle.
constexpr int kMostCorners = 3 + kClipPlanes;

struct Polygon {
  ClipVertex corners[kMostCorners];
  int count;
};

/// Negative if the plane cuts the vertex off: the same tests as in placeVector().
GALACTIC_EVERYWHERE inline float clipDistance(const ClipVertex& vertex, int plane, float near) {
  const float guard = kGuard * vertex.w;
  switch (plane) {
    case 0:
      return vertex.w - near;
    case 1:
      return guard - vertex.x;
    case 2:
      return guard + vertex.x;
    case 3:
      return guard - vertex.y;
    default:
      return guard + vertex.y;
  }
}

/// An order of vertices that is the same for all triangles.
GALACTIC_EVERYWHERE inline bool comesFirst(const ClipVertex& a, const ClipVertex& b) {
  if (a.w != b.w) return a.w < b.w;
  if (a.x != b.x) return a.x < b.x;
  return a.y < b.y;
}

GALACTIC_EVERYWHERE inline ClipVertex cutEdge(const ClipVertex& a, const ClipVertex& b, int plane,
                                              float near) {
  const bool in_order = comesFirst(a, b);
  const ClipVertex& p = in_order ? a : b;
  const ClipVertex& q = in_order ? b : a;
  const float p_distance = clipDistance(p, plane, near);
  const float share = p_distance / (p_distance - clipDistance(q, plane, near));
  const auto between = [share](float from, float to) { return from + (to - from) * share; };
  ClipVertex cut;
  cut.w = plane == 0 ? near : between(p.w, q.w);
  cut.x = between(p.x, q.x);
  cut.y = between(p.y, q.y);
  cut.u = between(p.u, q.u);
  cut.v = between(p.v, q.v);
  for (int n = 0; n < 4; ++n) cut.color[n] = between(p.color[n], q.color[n]);
  return cut;
}

/// Whether the plane cuts nothing off.
GALACTIC_EVERYWHERE inline bool liesWithin(const Polygon& polygon, int plane, float near) {
  for (int n = 0; n < polygon.count; ++n) {
    if (!(clipDistance(polygon.corners[n], plane, near) >= 0)) return false;
  }
  return true;
}

GALACTIC_EVERYWHERE inline void cutPolygon(const Polygon& from, int plane, float near,
                                           Polygon& to) {
  to.count = 0;
  for (int n = 0; n < from.count; ++n) {
    const ClipVertex& a = from.corners[n];
    const ClipVertex& b = from.corners[n + 1 == from.count ? 0 : n + 1];
    const bool a_stays = clipDistance(a, plane, near) >= 0;
    const bool b_stays = clipDistance(b, plane, near) >= 0;
    if (a_stays && to.count < kMostCorners) to.corners[to.count++] = a;
    if (a_stays != b_stays && to.count < kMostCorners) {
      to.corners[to.count++] = cutEdge(a, b, plane, near);
    }
  }
}

/// Vertex `number` of the state. If the surface has a texture, state.uv must be set.
template <class State>
GALACTIC_EVERYWHERE inline ClipVertex clipVertex(const State& state, std::uint32_t number) {
  const RenderCluster& cluster = *state.facts.cluster;
  const VertexFrame& frame = *state.frame;
  const std::uint32_t lane = state.vertex(number) % kWidth;
  const std::uint16_t* block = vertexBlock(state.facts, state.vertex(number)) + lane;
  const auto on_lattice = [](std::uint16_t q, std::int32_t origin) {
    return static_cast<float>(static_cast<std::int32_t>(q) + origin);
  };
  const float x = on_lattice(block[0], cluster.origin_x);
  const float y = on_lattice(block[kWidth], cluster.origin_y);
  const float z = on_lattice(block[std::size_t{2} * kWidth], cluster.origin_z);
  const auto at = [&](const float* row) {
    return ((row[0] * x + row[1] * y) + row[2] * z) + row[3];
  };
  ClipVertex vertex{at(frame.w), at(frame.x), at(frame.y), 0, 0, {}};
  if (state.facts.isTextured()) {
    const auto uv = pairAt(state.uv, number);
    vertex.u = uv.first;
    vertex.v = uv.second;
  }
  if (state.facts.color_kind != 0) {
    const auto color = static_cast<std::uint32_t>(state.colors[number]);
    for (int n = 0; n < 4; ++n) {
      vertex.color[n] = static_cast<float>((color >> (8 * n)) & 0xFFU);
    }
  }
  return vertex;
}

/// A vertex that needs no clipping.
template <class State>
GALACTIC_EVERYWHERE inline Corner cornerOf(const State& state, std::uint32_t number) {
  const ClipVertex vertex = clipVertex(state, number);
  const auto xy = pairAt(state.xy, number);
  Corner corner{xy.first, xy.second, state.z[number], vertex.u, vertex.v, {}};
  __builtin_memcpy(corner.color, vertex.color, sizeof(corner.color));
  return corner;
}

/// Projects a coordinate to 1/256 pixels in the image; false if it is NaN or out of range.
GALACTIC_EVERYWHERE inline bool projected(float value, float inverse, float middle,
                                          std::int32_t& place) {
  constexpr float kMost = 1 << 22;
  const float exact = value * inverse + middle;
  if (!(exact > -kMost && exact < kMost)) return false;
  place = as<std::int32_t>(exact + kToWhole) - as<std::int32_t>(kToWhole);
  return true;
}

GALACTIC_EVERYWHERE inline bool toCorner(const VertexFrame& frame, const ClipVertex& vertex,
                                         Corner& corner) {
  corner.z = 1.0F / vertex.w;
  if (!projected(vertex.x, corner.z, frame.middle_x, corner.x) ||
      !projected(vertex.y, corner.z, frame.middle_y, corner.y)) {
    return false;
  }
  corner.x -= frame.left;
  corner.y -= frame.top;
  corner.u = vertex.u;
  corner.v = vertex.v;
  __builtin_memcpy(corner.color, vertex.color, sizeof(corner.color));
  return true;
}

/// Clips a triangle of three vertices of the state. Returns how many corners are left, 0 or at
/// least 3, and writes them: a fan around the first one.
template <class State>
GALACTIC_EVERYWHERE inline int clipTriangle(const State& state, std::uint32_t a, std::uint32_t b,
                                            std::uint32_t c, Corner* ready) {
  const VertexFrame& frame = *state.frame;
  Polygon polygons[2];
  polygons[0].corners[0] = clipVertex(state, a);
  polygons[0].corners[1] = clipVertex(state, b);
  polygons[0].corners[2] = clipVertex(state, c);
  polygons[0].count = 3;
  int current = 0;
  for (int plane = 0; plane < kClipPlanes; ++plane) {
    if (liesWithin(polygons[current], plane, frame.near)) continue;
    cutPolygon(polygons[current], plane, frame.near, polygons[1 - current]);
    current = 1 - current;
    if (polygons[current].count < 3) return 0;
  }
  const Polygon& rest = polygons[current];
  for (int n = 0; n < rest.count; ++n) {
    if (!toCorner(frame, rest.corners[n], ready[n])) return 0;
  }
  return rest.count;
}

}  // namespace
}  // namespace galactic::render
