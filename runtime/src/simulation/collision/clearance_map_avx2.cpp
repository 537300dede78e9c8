// Compiled for AVX2: instantiates no library templates, see column_grid_avx2.cpp.
#include "simulation/collision/clearance_kernels.h"

#if defined(__x86_64__)
#include <immintrin.h>

#include "support/gather_avx2.inl"

namespace galactic::simulation {
namespace {

__m256 both(__m256 a, __m256 b) { return _mm256_and_ps(a, b); }

__m256 atLeast(__m256 a, __m256 b) { return _mm256_cmp_ps(a, b, _CMP_GE_OQ); }

__m256i integers(const std::int32_t* from) {
  return _mm256_load_si256(reinterpret_cast<const __m256i*>(from));
}

void store(std::int32_t* to, __m256i value) {
  _mm256_store_si256(reinterpret_cast<__m256i*>(to), value);
}

/// The indices of eight cells in tiles of eight by eight. `i`, `k`: their numbers along X and Z.
__m256i cellIndex(__m256i i, __m256i k, __m256i tiles_x) {
  const __m256i in_tile = _mm256_set1_epi32(7);
  const __m256i tile = _mm256_add_epi32(_mm256_mullo_epi32(_mm256_srli_epi32(k, 3), tiles_x),
                                        _mm256_srli_epi32(i, 3));
  const __m256i row = _mm256_slli_epi32(_mm256_and_si256(k, in_tile), 3);
  return _mm256_or_si256(_mm256_slli_epi32(tile, 6),
                         _mm256_or_si256(row, _mm256_and_si256(i, in_tile)));
}

/// Intermediate results for eight groups; coordinates are in steps.
struct alignas(32) Asked {
  float least_x[kLanes], most_x[kLanes], least_z[kLanes], most_z[kLanes];
  /// The middle of each group's cell.
  std::int32_t middle_x[kLanes], middle_z[kLanes];
  /// Indices of their cells; 0 for groups outside of the map.
  std::int32_t index[kLanes];
  /// All bits set for groups inside of the map.
  float inside[kLanes];
};

constexpr std::size_t kAtATime = 8;

/// Bounds of eight groups.
struct Bounds {
  __m256 least_x, most_x, least_y, most_y, least_z, most_z;
};

[[gnu::always_inline]] inline Bounds boundsAt(const float* from, std::size_t stride) {
  return {_mm256_loadu_ps(from),
          _mm256_loadu_ps(from + stride),
          _mm256_loadu_ps(from + 2 * stride),
          _mm256_loadu_ps(from + 3 * stride),
          _mm256_loadu_ps(from + 4 * stride),
          _mm256_loadu_ps(from + 5 * stride)};
}

/// The same bounds for all eight groups.
[[gnu::always_inline]] inline Bounds boundsOfAll(const float* from) {
  return {_mm256_broadcast_ss(from),     _mm256_broadcast_ss(from + 1),
          _mm256_broadcast_ss(from + 2), _mm256_broadcast_ss(from + 3),
          _mm256_broadcast_ss(from + 4), _mm256_broadcast_ss(from + 5)};
}

[[gnu::always_inline]] inline __m256 steps(__m256 bound, __m256 from, __m256 inverse_step) {
  return _mm256_mul_ps(_mm256_sub_ps(bound, from), inverse_step);
}

[[gnu::always_inline]] inline __m256 isWithin(__m256 value, const float* end) {
  return both(atLeast(value, _mm256_setzero_ps()),
              _mm256_cmp_ps(value, _mm256_load_ps(end), _CMP_LT_OQ));
}

[[gnu::always_inline]] inline void ask(const ClearanceLanes& lanes, const Bounds& bounds,
                                       Asked& asked) {
  const __m256 inverse_step = _mm256_load_ps(lanes.inverse_step);
  const __m256 min_x = _mm256_load_ps(lanes.min_x);
  const __m256 min_z = _mm256_load_ps(lanes.min_z);
  const __m256 least_x = steps(bounds.least_x, min_x, inverse_step);
  const __m256 most_x = steps(bounds.most_x, min_x, inverse_step);
  const __m256 least_z = steps(bounds.least_z, min_z, inverse_step);
  const __m256 most_z = steps(bounds.most_z, min_z, inverse_step);
  _mm256_store_ps(asked.least_x, least_x);
  _mm256_store_ps(asked.most_x, most_x);
  _mm256_store_ps(asked.least_z, least_z);
  _mm256_store_ps(asked.most_z, most_z);
  const __m256 half = _mm256_set1_ps(0.5F);
  const __m256 x = _mm256_mul_ps(half, _mm256_add_ps(least_x, most_x));
  const __m256 z = _mm256_mul_ps(half, _mm256_add_ps(least_z, most_z));
  const __m256 inside = both(both(isWithin(x, lanes.steps_x), isWithin(z, lanes.steps_z)),
                             both(atLeast(bounds.least_y, _mm256_load_ps(lanes.lowest)),
                                  atLeast(_mm256_load_ps(lanes.highest), bounds.most_y)));
  _mm256_store_ps(asked.inside, inside);
  const __m256 above = _mm256_mul_ps(_mm256_sub_ps(bounds.least_y, _mm256_load_ps(lanes.band_from)),
                                     _mm256_load_ps(lanes.inverse_band));
  const __m256 is_high = atLeast(bounds.least_y, _mm256_load_ps(lanes.low));
  const __m256i one = _mm256_set1_epi32(1);
  const __m256i number = _mm256_min_epi32(_mm256_add_epi32(_mm256_cvttps_epi32(above), one),
                                          _mm256_set1_epi32(kClearancePlanes - 1));
  const __m256i plane = _mm256_and_si256(number, _mm256_castps_si256(is_high));
  static_assert(kStepsPerCell == 2);
  const __m256i step_x = _mm256_cvttps_epi32(x);
  const __m256i step_z = _mm256_cvttps_epi32(z);
  store(asked.middle_x, _mm256_or_si256(step_x, one));
  store(asked.middle_z, _mm256_or_si256(step_z, one));
  const __m256i cell = cellIndex(_mm256_srli_epi32(step_x, 1), _mm256_srli_epi32(step_z, 1),
                                 integers(lanes.tiles_x));
  const __m256i first = _mm256_add_epi32(integers(lanes.first),
                                         _mm256_mullo_epi32(plane, integers(lanes.band_cells)));
  // Lanes outside of the map read cell 0; their answer is no.
  store(asked.index, _mm256_and_si256(_mm256_add_epi32(first, cell), _mm256_castps_si256(inside)));
}

template <int kSide>
[[gnu::always_inline]] inline __m256i roomOn(__m256i rooms) {
  return _mm256_and_si256(_mm256_srli_epi32(rooms, kSide), _mm256_set1_epi32(kMostRoom));
}

[[gnu::always_inline]] inline void answer(const RoomAround* cells, const Asked& asked,
                                          SureGroups& sure) {
  const __m256i rooms = detail::gatherEight<sizeof(*cells)>(cells, detail::indicesAt(asked.index));
  const __m256i middle_x = integers(asked.middle_x);
  const __m256i middle_z = integers(asked.middle_z);
  const auto down = [](const float* least, __m256i middle, __m256i room) {
    return _mm256_sub_ps(_mm256_load_ps(least), _mm256_cvtepi32_ps(_mm256_sub_epi32(middle, room)));
  };
  const auto up = [](const float* most, __m256i middle, __m256i room) {
    return _mm256_sub_ps(_mm256_cvtepi32_ps(_mm256_add_epi32(middle, room)), _mm256_load_ps(most));
  };
  const __m256 down_x = down(asked.least_x, middle_x, roomOn<kRoomDownX>(rooms));
  const __m256 up_x = up(asked.most_x, middle_x, roomOn<kRoomUpX>(rooms));
  const __m256 down_z = down(asked.least_z, middle_z, roomOn<kRoomDownZ>(rooms));
  const __m256 up_z = up(asked.most_z, middle_z, roomOn<kRoomUpZ>(rooms));
  const __m256 least = _mm256_min_ps(_mm256_min_ps(down_x, up_x), _mm256_min_ps(down_z, up_z));
  const __m256 free =
      both(_mm256_load_ps(asked.inside), _mm256_cmp_ps(least, _mm256_setzero_ps(), _CMP_GT_OQ));
  _mm256_store_ps(sure.down_x.values, down_x);
  _mm256_store_ps(sure.up_x.values, up_x);
  _mm256_store_ps(sure.down_z.values, down_z);
  _mm256_store_ps(sure.up_z.values, up_z);
  sure.free = static_cast<unsigned>(_mm256_movemask_ps(free));
}

}  // namespace

// Runs each step for several questions, because a core can queue only few loads whose addresses are
// not known yet.

void surelyFreeAvx2(const ClearanceQuestion* questions, std::size_t count, const RoomAround* cells,
                    std::size_t stride, SureGroups* sure) noexcept {
  Asked asked[kAtATime];
  for (std::size_t first = 0; first < count; first += kAtATime) {
    const std::size_t here = count - first < kAtATime ? count - first : kAtATime;
    for (std::size_t n = 0; n < here; ++n) {
      const ClearanceQuestion& question = questions[first + n];
      ask(*question.lanes, boundsAt(question.bounds, stride), asked[n]);
    }
    for (std::size_t n = 0; n < here; ++n) {
      answer(cells, asked[n], sure[first + n]);
    }
  }
}

void boxesSurelyFreeAvx2(const BoxQuestion* questions, std::size_t count, const RoomAround* cells,
                         unsigned* free) noexcept {
  Asked asked[kAtATime];
  for (std::size_t first = 0; first < count; first += kAtATime) {
    const std::size_t here = count - first < kAtATime ? count - first : kAtATime;
    for (std::size_t n = 0; n < here; ++n) {
      const BoxQuestion& question = questions[first + n];
      ask(*question.lanes, boundsOfAll(question.bounds->values), asked[n]);
    }
    for (std::size_t n = 0; n < here; ++n) {
      SureGroups sure;
      answer(cells, asked[n], sure);
      free[first + n] = sure.free;
    }
  }
}

unsigned freeAfterAvx2(const ClearanceLanes& lanes, const SureGroups& sure, float x,
                       float z) noexcept {
  const __m256 inverse_step = _mm256_load_ps(lanes.inverse_step);
  const __m256 by_x = _mm256_mul_ps(_mm256_set1_ps(x), inverse_step);
  const __m256 by_z = _mm256_mul_ps(_mm256_set1_ps(z), inverse_step);
  const __m256 rounding = _mm256_set1_ps(kMoveRounding);
  const auto goes = [rounding](const SlackOfGroups& slack, __m256 by) {
    return atLeast(_mm256_load_ps(slack.values), _mm256_add_ps(by, rounding));
  };
  const __m256 zero = _mm256_setzero_ps();
  const __m256 free =
      both(both(goes(sure.down_x, _mm256_sub_ps(zero, by_x)), goes(sure.up_x, by_x)),
           both(goes(sure.down_z, _mm256_sub_ps(zero, by_z)), goes(sure.up_z, by_z)));
  return static_cast<unsigned>(_mm256_movemask_ps(free)) & sure.free;
}

}  // namespace galactic::simulation

#else

namespace galactic::simulation {

// hasAvx2() is false on this architecture; the symbol exists so that callers need no condition.
void surelyFreeAvx2(const ClearanceQuestion* questions, std::size_t count, const RoomAround* cells,
                    std::size_t stride, SureGroups* sure) noexcept {
  surelyFreePortable(questions, count, cells, stride, sure);
}

void boxesSurelyFreeAvx2(const BoxQuestion* questions, std::size_t count, const RoomAround* cells,
                         unsigned* free) noexcept {
  boxesSurelyFreePortable(questions, count, cells, free);
}

unsigned freeAfterAvx2(const ClearanceLanes& lanes, const SureGroups& sure, float x,
                       float z) noexcept {
  return freeAfterPortable(lanes, sure, x, z);
}

}  // namespace galactic::simulation

#endif
