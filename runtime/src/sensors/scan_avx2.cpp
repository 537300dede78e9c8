// Compiled for AVX2. It includes no header whose inline functions it could instantiate: the linker
// may keep one copy of such a function for the whole program, and a copy built here would not run
// on an older processor. scan_portable.cpp explains what is computed.
#include "sensors/scan_kernels.h"

#if defined(__x86_64__)
#include <immintrin.h>

#include "support/gather_avx2.inl"

namespace galactic::sensors {
namespace {

/// Directions of eight beams in the ground plane, world frame.
struct Headings {
  __m256 x, z;
};

Headings headingsOf(const BeamBatch& beams, std::size_t n) {
  const __m256 cosine = _mm256_set1_ps(beams.cosine);
  const __m256 sine = _mm256_set1_ps(beams.sine);
  const __m256 ahead = _mm256_loadu_ps(beams.ahead + n);
  const __m256 right = _mm256_loadu_ps(beams.right + n);
  return {_mm256_add_ps(_mm256_mul_ps(cosine, ahead), _mm256_mul_ps(sine, right)),
          _mm256_sub_ps(_mm256_mul_ps(cosine, right), _mm256_mul_ps(sine, ahead))};
}

__m256 inverseOf(__m256 value) { return _mm256_div_ps(_mm256_set1_ps(1), value); }

__m256 oneWherePositive(__m256 value) {
  return _mm256_and_ps(_mm256_cmp_ps(value, _mm256_setzero_ps(), _CMP_GT_OQ), _mm256_set1_ps(1));
}

/// What all beams have in common.
struct Plane {
  __m256 from_x, from_z, last_i, last_k, range;
  __m256i columns_x;
  const int* cells;
};

/// The state of eight beams.
struct Beams {
  /// Index of the first beam in the batch.
  std::size_t number;
  Headings heading;
  __m256 inverse_x, inverse_z, beyond_x, beyond_z, way;
  /// The lanes whose beams have not ended yet.
  __m256 open;
};

Beams beamsOf(const BeamBatch& batch, std::size_t n, const Plane& plane) {
  Beams beams;
  beams.number = n;
  beams.heading = headingsOf(batch, n);
  beams.inverse_x = inverseOf(beams.heading.x);
  beams.inverse_z = inverseOf(beams.heading.z);
  beams.beyond_x = oneWherePositive(beams.heading.x);
  beams.beyond_z = oneWherePositive(beams.heading.z);
  beams.way = _mm256_setzero_ps();
  beams.open = _mm256_cmp_ps(beams.way, plane.range, _CMP_LT_OQ);
  return beams;
}

__m256 cellsOf(__m256 from, __m256 way, __m256 heading, __m256 last) {
  const __m256 at = _mm256_add_ps(from, _mm256_mul_ps(way, heading));
  const __m256 inside = _mm256_min_ps(_mm256_max_ps(at, _mm256_setzero_ps()), last);
  return _mm256_round_ps(inside, _MM_FROUND_TO_ZERO | _MM_FROUND_NO_EXC);
}

[[gnu::always_inline]] inline void goOn(const Plane& plane, Beams& beams) {
  const __m256 i = cellsOf(plane.from_x, beams.way, beams.heading.x, plane.last_i);
  const __m256 k = cellsOf(plane.from_z, beams.way, beams.heading.z, plane.last_k);
  const __m256i index = _mm256_add_epi32(
      _mm256_mullo_epi32(_mm256_cvttps_epi32(k), plane.columns_x), _mm256_cvttps_epi32(i));
  const __m256i words = detail::gatherEight<1>(plane.cells, index);
  const __m256i cell = _mm256_and_si256(words, _mm256_set1_epi32(0xff));
  const __m256 blocked = _mm256_castsi256_ps(_mm256_cmpeq_epi32(cell, _mm256_setzero_si256()));
  const __m256 leave_x =
      _mm256_mul_ps(_mm256_sub_ps(_mm256_add_ps(i, beams.beyond_x), plane.from_x), beams.inverse_x);
  const __m256 leave_z =
      _mm256_mul_ps(_mm256_sub_ps(_mm256_add_ps(k, beams.beyond_z), plane.from_z), beams.inverse_z);
  const __m256 promised = _mm256_sub_ps(_mm256_cvtepi32_ps(cell), _mm256_set1_ps(1));
  const __m256 jump = _mm256_add_ps(beams.way, _mm256_mul_ps(promised, _mm256_set1_ps(kJump)));
  const __m256 ahead = _mm256_max_ps(_mm256_min_ps(leave_x, leave_z), jump);
  const __m256 nudge =
      _mm256_max_ps(_mm256_mul_ps(ahead, _mm256_set1_ps(kNudgeOfWay)), _mm256_set1_ps(kNudge));
  const __m256 next = _mm256_add_ps(ahead, nudge);
  const __m256 moves = _mm256_andnot_ps(blocked, beams.open);
  beams.way = _mm256_blendv_ps(beams.way, next, moves);
  beams.open = _mm256_and_ps(moves, _mm256_cmp_ps(beams.way, plane.range, _CMP_LT_OQ));
}

void store(const Beams& beams, const ScanPlaneView& view, float range, float* distances) {
  const __m256 meters = _mm256_mul_ps(beams.way, _mm256_set1_ps(view.spacing));
  _mm256_storeu_ps(distances + beams.number, _mm256_min_ps(meters, _mm256_set1_ps(range)));
}

bool anyOpen(__m256 lanes) { return _mm256_movemask_ps(lanes) != 0; }

__m256 either(__m256 one) { return one; }

template <class... More>
__m256 either(__m256 one, More... more) {
  return _mm256_or_ps(one, either(more...));
}

/// Casts a few groups of eight beams side by side: while the processor waits for the cells of one
/// group, it computes the others.
template <class... Eight>
void castTogether(const Plane& plane, const ScanPlaneView& view, const BeamBatch& batch,
                  float* distances, Eight... eights) {
  while (anyOpen(either(eights.open...))) (goOn(plane, eights), ...);
  (store(eights, view, batch.range, distances), ...);
}

void castSceneAvx2(const ScanPlaneView& view, const BeamBatch& batch, float* distances) noexcept {
  const Plane plane{_mm256_set1_ps((batch.origin.x - view.min_x) * view.inverse_spacing),
                    _mm256_set1_ps((batch.origin.z - view.min_z) * view.inverse_spacing),
                    _mm256_set1_ps(static_cast<float>(view.columns_x - 1)),
                    _mm256_set1_ps(static_cast<float>(view.columns_z - 1)),
                    _mm256_set1_ps(batch.range * view.inverse_spacing),
                    _mm256_set1_epi32(view.columns_x),
                    reinterpret_cast<const int*>(view.cells)};
  const auto eight = [&](std::size_t n) { return beamsOf(batch, n * kBeamLanes, plane); };
  const std::size_t eights = batch.count / kBeamLanes;
  std::size_t n = 0;
  for (; n + 4 <= eights; n += 4) {
    castTogether(plane, view, batch, distances, eight(n), eight(n + 1), eight(n + 2), eight(n + 3));
  }
  switch (eights - n) {
    case 3:
      castTogether(plane, view, batch, distances, eight(n), eight(n + 1), eight(n + 2));
      break;
    case 2:
      castTogether(plane, view, batch, distances, eight(n), eight(n + 1));
      break;
    case 1:
      castTogether(plane, view, batch, distances, eight(n));
      break;
    default:
      break;
  }
}

/// The parts of eight beams that lie within all slabs so far.
struct Within {
  __m256 from, to;

  void keep(__m256 along, float to_low, float to_high) {
    const __m256 inverse = inverseOf(along);
    const __m256 low = _mm256_mul_ps(_mm256_set1_ps(to_low), inverse);
    const __m256 high = _mm256_mul_ps(_mm256_set1_ps(to_high), inverse);
    from = _mm256_max_ps(_mm256_min_ps(low, high), from);
    to = _mm256_min_ps(_mm256_max_ps(low, high), to);
  }
};

float along(const Vec3& axis, const Vec3& offset) {
  return axis.x * offset.x + axis.y * offset.y + axis.z * offset.z;
}

__m256 along(const Vec3& axis, const Headings& heading) {
  return _mm256_add_ps(_mm256_mul_ps(_mm256_set1_ps(axis.x), heading.x),
                       _mm256_mul_ps(_mm256_set1_ps(axis.z), heading.z));
}

void castBoxAvx2(const simulation::RestingBox& box, const BeamBatch& batch,
                 float* distances) noexcept {
  const Vec3 offset{batch.origin.x - box.center.x, batch.origin.y - box.center.y,
                    batch.origin.z - box.center.z};
  const float x = along(box.axis_x, offset);
  const float y = along(box.axis_y, offset);
  const float z = along(box.axis_z, offset);
  const Vec3& half = box.half_extents;
  for (std::size_t n = 0; n < batch.count; n += kBeamLanes) {
    const Headings heading = headingsOf(batch, n);
    const __m256 before = _mm256_loadu_ps(distances + n);
    Within within{_mm256_setzero_ps(), before};
    within.keep(along(box.axis_x, heading), -half.x - x, half.x - x);
    within.keep(along(box.axis_y, heading), -half.y - y, half.y - y);
    within.keep(along(box.axis_z, heading), -half.z - z, half.z - z);
    const __m256 meets = _mm256_cmp_ps(within.from, within.to, _CMP_LE_OQ);
    _mm256_storeu_ps(distances + n, _mm256_blendv_ps(before, within.from, meets));
  }
}

}  // namespace

ScanKernels avx2Scan() noexcept { return {castSceneAvx2, castBoxAvx2}; }

}  // namespace galactic::sensors

#else

namespace galactic::sensors {

// hasAvx2() is false on this architecture; the symbol exists so that callers need no condition.
ScanKernels avx2Scan() noexcept { return portableScan(); }

}  // namespace galactic::sensors

#endif
