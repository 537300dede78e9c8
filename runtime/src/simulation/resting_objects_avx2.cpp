// Compiled for AVX2. It includes no header whose inline functions it could instantiate: the linker
// may keep one copy of such a function for the whole program, and a copy built here would not run
// on an older processor.
#include "simulation/resting_objects_kernels.h"

#if defined(__x86_64__)
#include <immintrin.h>

namespace galactic::simulation {
namespace {

constexpr std::size_t kGroup = 8;
constexpr std::uint32_t kWordBits = 32;

/// The frame's numbers, one copy per lane.
struct Lanes {
  __m256 min_x, min_z, inverse_half_cell, last_x, last_z;
  __m256i windows_x;
};

struct Centres {
  __m256 x, y, z;
};

Lanes broadcast(const WindowFrame& frame) {
  return {_mm256_set1_ps(frame.min_x),
          _mm256_set1_ps(frame.min_z),
          _mm256_set1_ps(frame.inverse_half_cell),
          _mm256_set1_ps(static_cast<float>(frame.windows_x - 1)),
          _mm256_set1_ps(static_cast<float>(frame.windows_z - 1)),
          _mm256_set1_epi32(static_cast<int>(frame.windows_x))};
}

/// maxps gives its second operand when one is NaN: here 0, so that no lane reads out of range.
__m256i halfCells(__m256 coordinate, __m256 min, __m256 inverse_half_cell, __m256 last) {
  const __m256 cell = _mm256_mul_ps(_mm256_sub_ps(coordinate, min), inverse_half_cell);
  return _mm256_cvttps_epi32(_mm256_min_ps(_mm256_max_ps(cell, _mm256_setzero_ps()), last));
}

__m256i windowsOf(const Lanes& lanes, const Centres& centres) {
  const __m256i i = halfCells(centres.x, lanes.min_x, lanes.inverse_half_cell, lanes.last_x);
  const __m256i k = halfCells(centres.z, lanes.min_z, lanes.inverse_half_cell, lanes.last_z);
  return _mm256_add_epi32(_mm256_mullo_epi32(k, lanes.windows_x), i);
}

__m256 absolute(__m256 value) { return _mm256_andnot_ps(_mm256_set1_ps(-0.0F), value); }

/// How far beyond the faces across one axis: 0 between them; maxps passes NaN on.
__m256 beyond(const Vec3& axis, float half, const Centres& offset) {
  __m256 along = _mm256_mul_ps(_mm256_set1_ps(axis.x), offset.x);
  along = _mm256_add_ps(along, _mm256_mul_ps(_mm256_set1_ps(axis.y), offset.y));
  along = _mm256_add_ps(along, _mm256_mul_ps(_mm256_set1_ps(axis.z), offset.z));
  return _mm256_max_ps(_mm256_setzero_ps(), _mm256_sub_ps(absolute(along), _mm256_set1_ps(half)));
}

/// The lanes that overlap a box, as bits.
unsigned overlapping(const RestingBox& box, const Centres& centres, float radius) {
  const __m256 up = _mm256_sub_ps(centres.y, _mm256_set1_ps(box.centre.y));
  const __m256 reach = _mm256_set1_ps(box.half_height + radius);
  const __m256 at_height = _mm256_cmp_ps(absolute(up), reach, _CMP_LT_OQ);
  if (_mm256_testz_ps(at_height, at_height) != 0) return 0;
  const Centres offset{_mm256_sub_ps(centres.x, _mm256_set1_ps(box.centre.x)), up,
                       _mm256_sub_ps(centres.z, _mm256_set1_ps(box.centre.z))};
  const __m256 x = beyond(box.axis_x, box.half_extents.x, offset);
  const __m256 y = beyond(box.axis_y, box.half_extents.y, offset);
  const __m256 z = beyond(box.axis_z, box.half_extents.z, offset);
  const __m256 squared =
      _mm256_add_ps(_mm256_add_ps(_mm256_mul_ps(x, x), _mm256_mul_ps(y, y)), _mm256_mul_ps(z, z));
  const __m256 near = _mm256_cmp_ps(squared, _mm256_set1_ps(radius * radius), _CMP_LT_OQ);
  return static_cast<unsigned>(_mm256_movemask_ps(_mm256_and_ps(near, at_height)));
}

/// All bits that are set in any lane.
std::uint32_t anyLane(__m256i words) {
  __m128i any = _mm_or_si128(_mm256_castsi256_si128(words), _mm256_extracti128_si256(words, 1));
  any = _mm_or_si128(any, _mm_shuffle_epi32(any, 0x4e));
  any = _mm_or_si128(any, _mm_shuffle_epi32(any, 0xb1));
  return static_cast<std::uint32_t>(_mm_cvtsi128_si32(any));
}

/// The lanes that overlap an object of those that the lanes' windows know. Every such object is
/// tested against all lanes: what is not in a lane's window does not overlap its sphere.
unsigned touchingLanes(const RestingBox* boxes, __m256i words, const Centres& centres,
                       float radius) {
  unsigned lanes = 0;
  for (std::uint32_t word = anyLane(words); word != 0; word &= word - 1) {
    lanes |= overlapping(boxes[__builtin_ctz(word)], centres, radius);
  }
  return lanes;
}

}  // namespace

std::size_t firstTouchingGroupAvx2(const RestingView& objects, const SphereGroups& spheres,
                                   std::size_t first, unsigned& lanes) noexcept {
  const Lanes frame = broadcast(objects.frame);
  for (std::size_t group = first; group < spheres.groups; ++group) {
    const std::size_t n = group * kGroup;
    const Centres centres{_mm256_loadu_ps(spheres.x + n), _mm256_loadu_ps(spheres.y + n),
                          _mm256_loadu_ps(spheres.z + n)};
    const __m256i windows = windowsOf(frame, centres);
    unsigned touching = 0;
    for (std::size_t plane = 0; plane < objects.planes; ++plane) {
      const auto* base = reinterpret_cast<const int*>(objects.words + plane * objects.plane_stride);
      const __m256i words = _mm256_i32gather_epi32(base, windows, sizeof(std::uint32_t));
      if (_mm256_testz_si256(words, words) != 0) continue;
      touching |= touchingLanes(objects.boxes + plane * kWordBits, words, centres, spheres.radius);
    }
    if (touching == 0) continue;
    lanes = touching;
    return group;
  }
  return spheres.groups;
}

}  // namespace galactic::simulation

#else

namespace galactic::simulation {

// hasAvx2() is false on this architecture; the symbol exists so that callers need no condition.
std::size_t firstTouchingGroupAvx2(const RestingView& objects, const SphereGroups& spheres,
                                   std::size_t first, unsigned& lanes) noexcept {
  return firstTouchingGroupPortable(objects, spheres, first, lanes);
}

}  // namespace galactic::simulation

#endif
