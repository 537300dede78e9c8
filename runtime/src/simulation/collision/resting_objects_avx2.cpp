// Compiled for AVX2. It includes no header whose inline functions it could instantiate: the linker
// may keep one copy of such a function for the whole program, and a copy built here would not run
// on an older processor.
#include "simulation/collision/resting_objects_kernels.h"

#if defined(__x86_64__)
#include <immintrin.h>

#include "simulation/collision/packed_bounds.inl"

namespace galactic::simulation {
namespace {

struct Centers {
  __m256 x, y, z;
};

/// Cells of eight coordinates, as cellOf() of resting_objects.cpp.
__m256i cellsOf(__m256 coordinates, float edge) {
  const __m256 cell = _mm256_mul_ps(coordinates, _mm256_set1_ps(1 / edge));
  const __m256 below = _mm256_min_ps(cell, _mm256_set1_ps(kFarthestCell));
  return _mm256_cvtps_epi32(_mm256_max_ps(below, _mm256_set1_ps(-kFarthestCell)));
}

__m128i firstHalf(__m256i lanes) { return _mm256_castsi256_si128(lanes); }
__m128i secondHalf(__m256i lanes) { return _mm256_extracti128_si256(lanes, 1); }

/// The least of the even lanes and of the odd ones, in the first two.
__m128i leastOfBoth(__m128i a, __m128i b) {
  const __m128i least = _mm_min_epi32(_mm_unpacklo_epi32(a, b), _mm_unpackhi_epi32(a, b));
  return _mm_min_epi32(least, _mm_shuffle_epi32(least, 0x4e));
}

__m128i inverted(__m128i lanes) { return _mm_xor_si128(lanes, _mm_set1_epi32(-1)); }

/// The least and the most of eight cells along each of two axes.
void spansOf(__m256i a, __m256i b, CellSpan& span_a, CellSpan& span_b) {
  const __m128i least = leastOfBoth(_mm_min_epi32(firstHalf(a), secondHalf(a)),
                                    _mm_min_epi32(firstHalf(b), secondHalf(b)));
  // Inverting turns the order around.
  const __m128i most = inverted(leastOfBoth(inverted(_mm_max_epi32(firstHalf(a), secondHalf(a))),
                                            inverted(_mm_max_epi32(firstHalf(b), secondHalf(b)))));
  span_a = {_mm_cvtsi128_si32(least), _mm_cvtsi128_si32(most)};
  span_b = {_mm_extract_epi32(least, 1), _mm_extract_epi32(most, 1)};
}

QueryBounds boundsOf(const Centers& centers) {
  CellSpan x;
  CellSpan y;
  CellSpan z;
  spansOf(cellsOf(centers.x, kCellEdge), cellsOf(centers.z, kCellEdge), x, z);
  const __m256i heights = cellsOf(centers.y, kBandHeight);
  CellSpan same;
  spansOf(heights, heights, y, same);
  return queryBounds(x, y, z);
}

__m256 absolute(__m256 value) { return _mm256_andnot_ps(_mm256_set1_ps(-0.0F), value); }

/// How far beyond the faces across one axis: 0 between them; maxps passes NaN on.
__m256 beyond(const Vec3& axis, float half, const Centers& offset) {
  __m256 along = _mm256_mul_ps(_mm256_set1_ps(axis.x), offset.x);
  along = _mm256_add_ps(along, _mm256_mul_ps(_mm256_set1_ps(axis.y), offset.y));
  along = _mm256_add_ps(along, _mm256_mul_ps(_mm256_set1_ps(axis.z), offset.z));
  return _mm256_max_ps(_mm256_setzero_ps(), _mm256_sub_ps(absolute(along), _mm256_set1_ps(half)));
}

/// The lanes that overlap a box, as bits.
unsigned overlapping(const RestingBox& box, const Centers& centers, float radius) {
  const __m256 up = _mm256_sub_ps(centers.y, _mm256_set1_ps(box.center.y));
  const __m256 reach = _mm256_set1_ps(box.half_height + radius);
  const __m256 at_height = _mm256_cmp_ps(absolute(up), reach, _CMP_LT_OQ);
  if (_mm256_testz_ps(at_height, at_height) != 0) return 0;
  const Centers offset{_mm256_sub_ps(centers.x, _mm256_set1_ps(box.center.x)), up,
                       _mm256_sub_ps(centers.z, _mm256_set1_ps(box.center.z))};
  const __m256 x = beyond(box.axis_x, box.half_extents.x, offset);
  const __m256 y = beyond(box.axis_y, box.half_extents.y, offset);
  const __m256 z = beyond(box.axis_z, box.half_extents.z, offset);
  const __m256 squared =
      _mm256_add_ps(_mm256_add_ps(_mm256_mul_ps(x, x), _mm256_mul_ps(y, y)), _mm256_mul_ps(z, z));
  const __m256 near = _mm256_cmp_ps(squared, _mm256_set1_ps(radius * radius), _CMP_LT_OQ);
  return static_cast<unsigned>(_mm256_movemask_ps(_mm256_and_ps(near, at_height)));
}

Centers centersAt(const SphereBatch& spheres, std::size_t n) {
  return {_mm256_loadu_ps(spheres.x + n), _mm256_loadu_ps(spheres.y + n),
          _mm256_loadu_ps(spheres.z + n)};
}

/// The lanes that overlap an object, of those that the bounds of all eight meet, for the spheres
/// from `n` on.
unsigned touchingLanes(const RestingView& objects, const SphereBatch& spheres, std::size_t n,
                       float radius) {
  const Centers centers = centersAt(spheres, n);
  const QueryBounds query = boundsOf(centers);
  unsigned lanes = 0;
  for (std::size_t p = 0; p < objects.bounds_count; ++p) {
    const RestingBox* boxes = objects.boxes + p * kPackedObjects;
    for (std::uint32_t near = objectsNear(objects.bounds[p], query); near != 0; near &= near - 1) {
      lanes |= overlapping(boxes[__builtin_ctz(near)], centers, radius);
    }
  }
  return lanes;
}

}  // namespace

bool findTouchingAvx2(const RestingView& given_objects, const SphereBatch& given_spheres,
                      LaneGroup& at) noexcept {
  // Copies: nothing that is written below can change them.
  const RestingView objects = given_objects;
  const SphereBatch spheres = given_spheres;
  std::size_t group = at.group;
  for (std::size_t r = at.range; r < spheres.ranges.count; ++r, group = 0) {
    const RadiusRange range = spheres.ranges.first[r];
    const std::size_t end = std::size_t{range.first} + range.count;
    for (std::size_t n = range.first + group * kLanes; n < end; n += kLanes) {
      const unsigned lanes = touchingLanes(objects, spheres, n, range.radius);
      if (lanes == 0) continue;
      at = {r, (n - range.first) / kLanes, lanes};
      return true;
    }
  }
  return false;
}

}  // namespace galactic::simulation

#else

namespace galactic::simulation {

// hasAvx2() is false on this architecture; the symbol exists so that callers need no condition.
bool findTouchingAvx2(const RestingView& objects, const SphereBatch& spheres,
                      LaneGroup& at) noexcept {
  return findTouchingPortable(objects, spheres, at);
}

}  // namespace galactic::simulation

#endif
