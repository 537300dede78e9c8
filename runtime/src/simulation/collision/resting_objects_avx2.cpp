// Compiled for AVX2. It includes no header whose inline functions it could instantiate: the linker
// may keep one copy of such a function for the whole program, and a copy built here would not run
// on an older processor.
#include "simulation/collision/resting_objects_kernels.h"

#if defined(__x86_64__)
#include <immintrin.h>

#include "support/gather_avx2.inl"

namespace galactic::simulation {
namespace {

struct Centers {
  __m256 x, y, z;
};

/// Which sets eight spheres read: indices of strips, and squares along the vertical.
struct Places {
  __m256i x, y, z;
};

/// Squares of eight coordinates; the lowest number for NaN and for what 32 bits do not hold.
__m256i squaresOf(__m256 coordinates) {
  return _mm256_cvtps_epi32(_mm256_mul_ps(coordinates, _mm256_set1_ps(kInverseSquareEdge)));
}

Places placesOf(const Centers& centers) {
  const __m256i wrap = _mm256_set1_epi32(kStrips - 1);
  return {_mm256_and_si256(squaresOf(centers.x), wrap), squaresOf(centers.y),
          _mm256_and_si256(squaresOf(centers.z), wrap)};
}

/// The objects of one plane that all sets of a sphere know, for eight spheres.
__m256i objectsNear(const SetPlane& plane, const Places& places) {
  const __m256i in_strips =
      _mm256_and_si256(detail::gatherEight<sizeof(*plane.along_x)>(plane.along_x, places.x),
                       detail::gatherEight<sizeof(*plane.along_z)>(plane.along_z, places.z));
  // vpermd looks at three bits of an index: the square modulo kBands.
  const __m256i at_height = _mm256_permutevar8x32_epi32(
      _mm256_load_si256(reinterpret_cast<const __m256i*>(plane.at_height)), places.y);
  return _mm256_and_si256(in_strips, at_height);
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

/// All bits that are set in any lane.
std::uint32_t anyLane(__m256i words) {
  __m128i any = _mm_or_si128(_mm256_castsi256_si128(words), _mm256_extracti128_si256(words, 1));
  any = _mm_or_si128(any, _mm_shuffle_epi32(any, 0x4e));
  any = _mm_or_si128(any, _mm_shuffle_epi32(any, 0xb1));
  return static_cast<std::uint32_t>(_mm_cvtsi128_si32(any));
}

Centers centersAt(const SphereBatch& spheres, std::size_t n) {
  return {_mm256_loadu_ps(spheres.x + n), _mm256_loadu_ps(spheres.y + n),
          _mm256_loadu_ps(spheres.z + n)};
}

/// The lanes that overlap an object of those in the lanes' sets, for the spheres from `n` on. Every
/// such object is tested against all lanes: what is not in a lane's sets does not overlap its
/// sphere. Not inlined, and looks its objects up again, so that the loop around it keeps all its
/// numbers in registers: it is called for few groups.
[[gnu::noinline]] unsigned touchingLanes(const RestingView& objects, const SphereBatch& spheres,
                                         std::size_t n, float radius) {
  const Centers centers = centersAt(spheres, n);
  const Places places = placesOf(centers);
  unsigned lanes = 0;
  for (std::size_t plane = 0; plane < objects.plane_count; ++plane) {
    const RestingBox* boxes = objects.boxes + plane * kPlaneObjects;
    std::uint32_t near = anyLane(objectsNear(objects.planes[plane], places));
    for (; near != 0; near &= near - 1) {
      lanes |= overlapping(boxes[__builtin_ctz(near)], centers, radius);
    }
  }
  return lanes;
}

/// Whether no plane has an object that all sets of a sphere know, for any of eight spheres.
bool nothingNear(const RestingView& objects, const Places& places) {
  __m256i near = objectsNear(objects.planes[0], places);
  for (std::size_t plane = 1; plane < objects.plane_count; ++plane) {
    near = _mm256_or_si256(near, objectsNear(objects.planes[plane], places));
  }
  return _mm256_testz_si256(near, near) != 0;
}

}  // namespace

bool findTouchingAvx2(const RestingView& given_objects, const SphereBatch& given_spheres,
                      LaneGroup& at) noexcept {
  // Copies: nothing that is written below can change them.
  const RestingView objects = given_objects;
  const SphereBatch spheres = given_spheres;
  if (objects.plane_count == 0) return false;
  std::size_t group = at.group;
  for (std::size_t r = at.range; r < spheres.ranges.count; ++r, group = 0) {
    const RadiusRange range = spheres.ranges.first[r];
    const std::size_t end = std::size_t{range.first} + range.count;
    for (std::size_t n = range.first + group * kLanes; n < end; n += kLanes) {
      if (nothingNear(objects, placesOf(centersAt(spheres, n)))) continue;
      const unsigned lanes = touchingLanes(given_objects, given_spheres, n, range.radius);
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
