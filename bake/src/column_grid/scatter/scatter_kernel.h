#pragma once
// The vectorized core of the exact engine, included by one source file per instruction set.
#include "column_grid/scatter/scatter.h"
#include "column_grid/scatter/simd.h"

namespace galactic::bake {
namespace {

/// Heights per lane, relative to the triangle's first corner; empty where lo >= hi.
struct Heights {
  Floats lo;
  Floats hi;
};

inline Floats kBig() { return broadcast(1e30F); }
inline Floats kSmall() { return broadcast(-1e30F); }

inline void includeWhere(Mask where, Floats lo, Floats hi, Heights& heights) {
  heights.lo = minimum(heights.lo, select(where, lo, kBig()));
  heights.hi = maximum(heights.hi, select(where, hi, kSmall()));
}

/// The ball around a corner.
inline void includeCorner(const ScatterTriangle& triangle, int corner, Floats x, float z,
                          float radius, Heights& heights) {
  const float dz = z - triangle.corner_z[corner];
  const Floats dx = x - broadcast(triangle.corner_x[corner]);
  const Floats y = broadcast(triangle.corner_y[corner]);
  const Floats rest = broadcast(radius * radius - dz * dz) - dx * dx;
  const Floats zero = broadcast(0);
  const Floats reach = squareRoot(maximum(rest, zero));
  includeWhere(less(zero, rest), y - reach, y + reach, heights);
}

/// The cylinder around an edge, cut off at its ends. Returns the distance from the edge's line.
inline Floats includeEdge(const ScatterEdge& edge, Floats x, float z, float radius,
                          Heights& heights) {
  const Floats zero = broadcast(0);
  const Floats distance =
      x * broadcast(edge.distance_x) + broadcast(edge.distance_z * z + edge.distance_0);
  const Floats along = x * broadcast(edge.along_x) + broadcast(edge.along_z * z + edge.along_0);
  const Floats rest = broadcast(radius * radius) - distance * distance;
  const Floats half = squareRoot(maximum(rest, zero)) * broadcast(edge.secant);
  const Floats start_y = broadcast(edge.start_y);
  const Floats center = start_y + along * broadcast(edge.slope);
  const Floats end_a = start_y - along * broadcast(edge.cotangent);
  const Floats end_b = end_a + broadcast(edge.end_rise);
  const Floats lo = maximum(center - half, minimum(end_a, end_b));
  const Floats hi = minimum(center + half, maximum(end_a, end_b));
  includeWhere(both(less(zero, rest), less(lo, hi)), lo, hi, heights);
  return distance;
}

/// How far a column is inside the borders of the raised and of the lowered face; negative outside.
struct FaceInside {
  Floats raised;
  Floats lowered;
};

/// The prism between the faces raised and lowered along the normal by the radius. A column meets
/// the raised face if it is inside all three shifted borders of that face, and likewise for the
/// lowered one. If it meets only one of them, the height at the face itself bounds the other side.
inline void includeFace(const ScatterTriangle& triangle, Floats x, float z, float radius,
                        const FaceInside& inside, Heights& heights) {
  const Floats zero = broadcast(0);
  const Floats plane = x * broadcast(triangle.normal_x) + broadcast(triangle.normal_z * z);
  const Floats rise = broadcast(radius * triangle.normal_y);
  const Floats inverse = broadcast(triangle.inverse_normal_y);
  const Floats min_y = broadcast(triangle.min_y);
  const Floats max_y = broadcast(triangle.max_y);
  const Floats raised =
      maximum(min_y, minimum(max_y, (broadcast(radius) - plane) * inverse - rise));
  const Floats lowered =
      maximum(min_y, minimum(max_y, (broadcast(-radius) - plane) * inverse + rise));
  const Mask no_raised = less(inside.raised, zero);
  const Mask no_lowered = less(inside.lowered, zero);
  heights.hi = maximum(heights.hi, select(no_raised, kSmall(), raised + rise));
  heights.lo = minimum(heights.lo, select(no_raised, kBig(), raised));
  heights.lo = minimum(heights.lo, select(no_lowered, kBig(), lowered - rise));
  heights.hi = maximum(heights.hi, select(no_lowered, kSmall(), lowered));
}

inline Heights touchingHeights(const ScatterTriangle& triangle, Floats x, float z, float radius) {
  Heights heights{kBig(), kSmall()};
  FaceInside inside{kBig(), kBig()};
  for (int i = 0; i < 3; ++i) {
    includeCorner(triangle, i, x, z, radius, heights);
    const ScatterEdge& edge = triangle.edges[i];
    if (edge.vertical) continue;
    const Floats distance = includeEdge(edge, x, z, radius, heights);
    inside.raised = minimum(inside.raised, distance - broadcast(edge.face_shift));
    inside.lowered = minimum(inside.lowered, distance + broadcast(edge.face_shift));
  }
  if (triangle.has_face) {
    includeFace(triangle, x, z, radius, inside, heights);
  }
  return heights;
}

/// The lanes that the triangle may still extend: those within the radius of its box whose current
/// interval does not yet cover all that the box could block. This takes one square root, the exact
/// heights six. Each lane is decided alone, so the result does not depend on the width of the
/// vectors.
inline Mask mayGain(const ScatterTriangle& triangle, Floats x, float z, float radius,
                    Heights current) {
  const Floats zero = broadcast(0);
  const float dz =
      triangle.min_z > z ? triangle.min_z - z : (z > triangle.max_z ? z - triangle.max_z : 0.0F);
  const Floats dx =
      maximum(maximum(broadcast(triangle.min_x) - x, x - broadcast(triangle.max_x)), zero);
  const Floats rest = broadcast(radius * radius - dz * dz) - dx * dx;
  const Floats reach = squareRoot(maximum(rest, zero));
  const Floats lo = broadcast(triangle.min_y) - reach + broadcast(triangle.origin_y);
  const Floats hi = broadcast(triangle.max_y) + reach + broadcast(triangle.origin_y);
  return both(less(zero, rest), either(less(lo, current.lo), less(current.hi, hi)));
}

inline Floats laneNumbers() {
  alignas(64) constexpr float kNumbers[16] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
  return load(kNumbers);
}

/// Extends the current intervals of the columns at `lo` and `hi` by `add` in the lanes of `lanes`.
/// Returns the lanes whose added interval is disjoint from the current one.
inline unsigned extend(Heights add, Mask lanes, float* lo, float* hi) {
  const Heights current{load(lo), load(hi)};
  const Mask valid = both(lanes, less(add.lo, add.hi));
  const Mask disjoint = either(less(current.hi, add.lo), less(add.hi, current.lo));
  const Mask occupied = less(current.lo, current.hi);
  const Mask apart = both(valid, both(disjoint, occupied));
  const Mask joined = without(valid, apart);
  store(lo, select(joined, minimum(current.lo, add.lo), current.lo));
  store(hi, select(joined, maximum(current.hi, add.hi), current.hi));
  return bits(apart);
}

/// The columns of one row, kLanes at a time.
inline void scatterRow(const ScatterTriangle& triangle, std::uint32_t row,
                       const ScatterBlock& block, float radius, const ScatterTarget& target) {
  const std::uint64_t row_start = (row - target.first_row) * target.stride;
  const float z = static_cast<float>(target.z[row] - triangle.origin_z);
  const Floats origin_y = broadcast(triangle.origin_y);
  for (std::uint32_t i = block.first_column; i < block.end_column; i += kLanes) {
    float* lo_at = target.lo + row_start + i;
    float* hi_at = target.hi + row_start + i;
    const Floats x = (load(target.x_high + i) - broadcast(triangle.origin_x_high)) +
                     (load(target.x_low + i) - broadcast(triangle.origin_x_low));
    const Mask in_range = less(laneNumbers(), broadcast(static_cast<float>(block.end_column - i)));
    const Mask lanes = both(in_range, mayGain(triangle, x, z, radius, {load(lo_at), load(hi_at)}));
    if (bits(lanes) == 0) continue;
    const Heights relative = touchingHeights(triangle, x, z, radius);
    const Heights heights{relative.lo + origin_y, relative.hi + origin_y};
    unsigned apart = extend(heights, lanes, lo_at, hi_at);
    if (apart == 0) continue;
    alignas(64) float lo[kLanes];
    alignas(64) float hi[kLanes];
    store(lo, heights.lo);
    store(hi, heights.hi);
    for (; apart != 0; apart &= apart - 1) {
      const auto lane = static_cast<unsigned>(__builtin_ctz(apart));
      spillInto(*target.strip, row, i + lane, lo[lane], hi[lane]);
    }
  }
}

inline void scatterBlock(const ScatterTriangle& triangle, const ScatterBlock& block, float radius,
                         const ScatterTarget& target) {
  for (std::uint32_t row = block.first_row; row < block.end_row; ++row) {
    scatterRow(triangle, row, block, radius, target);
  }
}

}  // namespace
}  // namespace galactic::bake
