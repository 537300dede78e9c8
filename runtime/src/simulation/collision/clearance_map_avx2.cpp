// Compiled for AVX2: instantiates no library templates, see column_grid_avx2.cpp.
#include "simulation/collision/clearance_kernels.h"

#if defined(__x86_64__)
#include <immintrin.h>

#include "support/gather_avx2.inl"

namespace galactic::simulation {
namespace {

__m256 half(__m256 a, __m256 b) { return _mm256_mul_ps(_mm256_set1_ps(0.5F), _mm256_add_ps(a, b)); }

__m256 both(__m256 a, __m256 b) { return _mm256_and_ps(a, b); }

__m256 atLeast(__m256 a, __m256 b) { return _mm256_cmp_ps(a, b, _CMP_GE_OQ); }

/// See reachBeyond() in clearance_map.cpp.
__m256 reachBeyond(__m256 edge, __m256 part) {
  const __m256 to_border = _mm256_min_ps(_mm256_sub_ps(_mm256_set1_ps(1), part), part);
  return _mm256_mul_ps(_mm256_set1_ps(kColumnsPerCell),
                       _mm256_sub_ps(_mm256_mul_ps(_mm256_set1_ps(0.5F), edge), to_border));
}

__m256i integers(const std::int32_t* from) {
  return _mm256_load_si256(reinterpret_cast<const __m256i*>(from));
}

/// Where the bytes of eight cells are, in tiles of eight by eight.
__m256i cellIndex(__m256i i, __m256i k, __m256i tiles_x) {
  const __m256i in_tile = _mm256_set1_epi32(7);
  const __m256i tile = _mm256_add_epi32(_mm256_mullo_epi32(_mm256_srli_epi32(k, 3), tiles_x),
                                        _mm256_srli_epi32(i, 3));
  const __m256i row = _mm256_slli_epi32(_mm256_and_si256(k, in_tile), 3);
  return _mm256_or_si256(_mm256_slli_epi32(tile, 6),
                         _mm256_or_si256(row, _mm256_and_si256(i, in_tile)));
}

/// Eight groups on the way to an answer.
struct alignas(32) Asked {
  /// Where the distances of their cells are; 0 for those elsewhere.
  std::int32_t index[kLanes];
  /// What the distance has to be at least, in columns.
  float needed[kLanes];
  /// All bits of those inside of the map.
  float inside[kLanes];
};

[[gnu::always_inline]] inline void ask(const ClearanceLanes& lanes, const float* bounds,
                                       std::size_t stride, Asked& asked, SureGroups& sure) {
  const __m256 least_x = _mm256_loadu_ps(bounds);
  const __m256 most_x = _mm256_loadu_ps(bounds + stride);
  const __m256 least_y = _mm256_loadu_ps(bounds + 2 * stride);
  const __m256 most_y = _mm256_loadu_ps(bounds + 3 * stride);
  const __m256 least_z = _mm256_loadu_ps(bounds + 4 * stride);
  const __m256 most_z = _mm256_loadu_ps(bounds + 5 * stride);
  const __m256 inverse_cell = _mm256_load_ps(lanes.inverse_cell);
  const __m256 x = _mm256_mul_ps(_mm256_sub_ps(half(least_x, most_x), _mm256_load_ps(lanes.min_x)),
                                 inverse_cell);
  const __m256 z = _mm256_mul_ps(_mm256_sub_ps(half(least_z, most_z), _mm256_load_ps(lanes.min_z)),
                                 inverse_cell);
  const __m256 zero = _mm256_setzero_ps();
  const __m256 over =
      both(both(atLeast(x, zero), _mm256_cmp_ps(x, _mm256_load_ps(lanes.cells_x), _CMP_LT_OQ)),
           both(atLeast(z, zero), _mm256_cmp_ps(z, _mm256_load_ps(lanes.cells_z), _CMP_LT_OQ)));
  const __m256 inside = both(over, both(atLeast(least_y, _mm256_load_ps(lanes.lowest)),
                                        atLeast(_mm256_load_ps(lanes.highest), most_y)));
  const __m256i mask = _mm256_castps_si256(inside);
  // Lanes elsewhere read byte 0; their answer is no.
  const __m256 above = _mm256_mul_ps(_mm256_sub_ps(least_y, _mm256_load_ps(lanes.band_from)),
                                     _mm256_load_ps(lanes.inverse_band));
  const __m256 is_high = atLeast(least_y, _mm256_load_ps(lanes.low));
  const __m256i one = _mm256_set1_epi32(1);
  const __m256i number = _mm256_min_epi32(_mm256_add_epi32(_mm256_cvttps_epi32(above), one),
                                          _mm256_set1_epi32(kClearancePlanes - 1));
  const __m256i plane = _mm256_and_si256(number, _mm256_castps_si256(is_high));
  const __m256i i = _mm256_cvttps_epi32(x);
  const __m256i k = _mm256_cvttps_epi32(z);
  const __m256i cell = cellIndex(i, k, integers(lanes.tiles_x));
  const __m256i first = _mm256_add_epi32(integers(lanes.first),
                                         _mm256_mullo_epi32(plane, integers(lanes.band_bytes)));
  const __m256i index = _mm256_and_si256(_mm256_add_epi32(first, cell), mask);
  const __m256 wide = _mm256_mul_ps(_mm256_sub_ps(most_x, least_x), inverse_cell);
  const __m256 deep = _mm256_mul_ps(_mm256_sub_ps(most_z, least_z), inverse_cell);
  const __m256 along_x = reachBeyond(wide, _mm256_sub_ps(x, _mm256_cvtepi32_ps(i)));
  const __m256 along_z = reachBeyond(deep, _mm256_sub_ps(z, _mm256_cvtepi32_ps(k)));
  _mm256_store_si256(reinterpret_cast<__m256i*>(asked.index), index);
  _mm256_store_ps(asked.needed,
                  _mm256_add_ps(_mm256_max_ps(along_z, along_x), _mm256_set1_ps(kBeyondReach)));
  _mm256_store_ps(asked.inside, inside);
  constexpr unsigned kAll = (1U << kLanes) - 1;
  sure.low = static_cast<unsigned>(_mm256_movemask_ps(is_high)) ^ kAll;
}

[[gnu::always_inline]] inline void answer(const ClearanceLanes& lanes, const std::uint8_t* cells,
                                          const Asked& asked, SureGroups& sure) {
  const __m256i words = detail::gatherEight<sizeof(*cells)>(cells, detail::indicesAt(asked.index));
  const __m256 distance = _mm256_cvtepi32_ps(_mm256_and_si256(words, _mm256_set1_epi32(0xff)));
  // Apart, so that only the first has to wait for the words.
  const __m256 slack = _mm256_sub_ps(distance, _mm256_load_ps(asked.needed));
  const __m256 free = both(_mm256_load_ps(asked.inside), atLeast(slack, _mm256_setzero_ps()));
  _mm256_store_ps(sure.slack,
                  _mm256_blendv_ps(_mm256_set1_ps(-1),
                                   _mm256_mul_ps(slack, _mm256_load_ps(lanes.column)), free));
  sure.free = static_cast<unsigned>(_mm256_movemask_ps(free));
}

}  // namespace

void surelyFreeAvx2(const ClearanceQuestion* questions, std::size_t count,
                    const std::uint8_t* cells, std::size_t stride, SureGroups* sure) noexcept {
  // Each step for several: a core can hold back few loads whose addresses are not known yet.
  constexpr std::size_t kAtATime = 8;
  Asked asked[kAtATime];
  for (std::size_t first = 0; first < count; first += kAtATime) {
    const std::size_t here = count - first < kAtATime ? count - first : kAtATime;
    for (std::size_t n = 0; n < here; ++n) {
      const ClearanceQuestion& question = questions[first + n];
      ask(*question.lanes, question.bounds, stride, asked[n], sure[first + n]);
    }
    for (std::size_t n = 0; n < here; ++n) {
      answer(*questions[first + n].lanes, cells, asked[n], sure[first + n]);
    }
  }
}

unsigned freeWithinAvx2(const SureGroups& sure, float reach) noexcept {
  return static_cast<unsigned>(
      _mm256_movemask_ps(atLeast(_mm256_load_ps(sure.slack), _mm256_set1_ps(reach))));
}

}  // namespace galactic::simulation

#else

namespace galactic::simulation {

// hasAvx2() is false on this architecture; the symbol exists so that callers need no condition.
void surelyFreeAvx2(const ClearanceQuestion* questions, std::size_t count,
                    const std::uint8_t* cells, std::size_t stride, SureGroups* sure) noexcept {
  surelyFreePortable(questions, count, cells, stride, sure);
}

unsigned freeWithinAvx2(const SureGroups& sure, float reach) noexcept {
  return freeWithinPortable(sure, reach);
}

}  // namespace galactic::simulation

#endif
