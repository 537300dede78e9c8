// Compiled for AVX2: instantiates no library templates, see column_grid_avx2.cpp.
#include "simulation/ways_out/way_out_kernels.h"

#if defined(__x86_64__)
#include <immintrin.h>

namespace galactic::simulation {
namespace {

__m256i load(const std::uint32_t* from) {
  return _mm256_load_si256(reinterpret_cast<const __m256i*>(from));
}

__m256i load(const std::int32_t* from) {
  return _mm256_load_si256(reinterpret_cast<const __m256i*>(from));
}

void store(std::uint32_t* to, __m256i value) {
  _mm256_store_si256(reinterpret_cast<__m256i*>(to), value);
}

/// All bits of the lanes whose bit is set.
__m256i lanesOf(unsigned bits) {
  const __m256i each = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
  return _mm256_cmpeq_epi32(_mm256_and_si256(_mm256_set1_epi32(static_cast<int>(bits)), each),
                            each);
}

/// Pairs of rows from their sphere's column on, nine bits each: what the shift brings from the upper
/// row into the lower one lies beyond its nine.
__m256i shifted(__m256i pair, __m256i column) {
  return _mm256_and_si256(_mm256_srlv_epi32(pair, column), _mm256_set1_epi32(0x01ff'01ff));
}

__m128i fourPairs(const std::uint16_t* from) {
  return _mm_loadu_si128(reinterpret_cast<const __m128i*>(from));
}

/// The same of two spheres, one in each half.
__m256i fourPairs(const std::uint16_t* lower, const std::uint16_t* upper) {
  return _mm256_inserti128_si256(_mm256_castsi128_si256(fourPairs(lower)), fourPairs(upper), 1);
}

int onePair(const std::uint16_t* from) {
  int pair;
  __builtin_memcpy(&pair, from, sizeof(pair));
  return pair;
}

/// The five pairs of rows of eight spheres, a lane for each: loaded sphere by sphere and transposed,
/// which takes less time than the instructions that gather.
void readPairs(const std::uint16_t* rows, const std::int32_t* row, __m256i pairs[kRowPairs]) {
  const std::uint16_t* at[kLanes];
  for (std::size_t n = 0; n < kLanes; ++n) at[n] = rows + row[n];
  const __m256i a = fourPairs(at[0], at[4]);
  const __m256i b = fourPairs(at[1], at[5]);
  const __m256i c = fourPairs(at[2], at[6]);
  const __m256i d = fourPairs(at[3], at[7]);
  const __m256i ab_first = _mm256_unpacklo_epi32(a, b);
  const __m256i ab_last = _mm256_unpackhi_epi32(a, b);
  const __m256i cd_first = _mm256_unpacklo_epi32(c, d);
  const __m256i cd_last = _mm256_unpackhi_epi32(c, d);
  pairs[0] = _mm256_unpacklo_epi64(ab_first, cd_first);
  pairs[1] = _mm256_unpackhi_epi64(ab_first, cd_first);
  pairs[2] = _mm256_unpacklo_epi64(ab_last, cd_last);
  pairs[3] = _mm256_unpackhi_epi64(ab_last, cd_last);
  constexpr std::size_t kFifth = 2 * (kRowPairs - 1);
  pairs[4] = _mm256_setr_epi32(onePair(at[0] + kFifth), onePair(at[1] + kFifth),
                               onePair(at[2] + kFifth), onePair(at[3] + kFifth),
                               onePair(at[4] + kFifth), onePair(at[5] + kFifth),
                               onePair(at[6] + kFifth), onePair(at[7] + kFifth));
}

/// The sign bit of each lane: whether the sphere is free in a cell.
__m256 isFree(const EightWays& ways, const WayCell& cell) {
  const int row = cell.z + kCellsAround;
  const int bit = 16 * (row % 2) + cell.x + kCellsAround;
  return _mm256_castsi256_ps(
      _mm256_sll_epi32(load(ways.rows[row / 2]), _mm_cvtsi32_si128(31 - bit)));
}

/// How far places in a cell are from the border that a move towards `sign` crosses last.
__m256 fromBorder(const float* part, int sign) {
  const __m256 parts = _mm256_load_ps(part);
  return sign > 0 ? parts : _mm256_sub_ps(_mm256_set1_ps(1), parts);
}

float leastOf(__m256 values) {
  __m128 least = _mm_min_ps(_mm256_castps256_ps128(values), _mm256_extractf128_ps(values, 1));
  least = _mm_min_ps(least, _mm_shuffle_ps(least, least, 0x4e));
  return _mm_cvtss_f32(_mm_min_ss(least, _mm_shuffle_ps(least, least, 0xb1)));
}

/// The cells along one axis that places may be in, from the spheres' own.
struct CellRanges {
  __m256i first, last;
};

CellRanges cellsAfter(const float* part, float by, float rounding) {
  if (by == 0) return {_mm256_setzero_si256(), _mm256_setzero_si256()};
  constexpr int kAbove = 64;
  const __m256 above = _mm256_set1_ps(static_cast<float>(kAbove));
  const __m256 cell = _mm256_add_ps(_mm256_add_ps(_mm256_load_ps(part), _mm256_set1_ps(by)), above);
  const __m256 slack = _mm256_set1_ps(rounding);
  const __m256i down = _mm256_set1_epi32(kAbove);
  return {_mm256_sub_epi32(_mm256_cvttps_epi32(_mm256_sub_ps(cell, slack)), down),
          _mm256_sub_epi32(_mm256_cvttps_epi32(_mm256_add_ps(cell, slack)), down)};
}

/// All bits of the lanes whose sphere is free in a cell of its own choice.
__m256i isFreeIn(const EightWays& ways, __m256i x, __m256i z) {
  const __m256i around = _mm256_set1_epi32(kCellsAround);
  const __m256i row = _mm256_add_epi32(z, around);
  const __m256i lane = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
  const __m256i index = _mm256_add_epi32(_mm256_slli_epi32(_mm256_srli_epi32(row, 1), 3), lane);
  // See resting_objects_avx2.cpp for why the gather is given a zero.
  const __m256i words =
      _mm256_mask_i32gather_epi32(_mm256_setzero_si256(), reinterpret_cast<const int*>(ways.rows),
                                  index, _mm256_set1_epi32(-1), sizeof(int));
  const __m256i half = _mm256_slli_epi32(_mm256_and_si256(row, _mm256_set1_epi32(1)), 4);
  const __m256i bit = _mm256_add_epi32(half, _mm256_add_epi32(x, around));
  const __m256i one = _mm256_set1_epi32(1);
  return _mm256_cmpeq_epi32(_mm256_and_si256(_mm256_srlv_epi32(words, bit), one), one);
}

bool areFree(const EightWays& ways, float by_x, float by_z, float rounding) {
  const __m256i counts = load(ways.counts);
  const CellRanges x = cellsAfter(ways.part_x, by_x, rounding);
  const CellRanges z = cellsAfter(ways.part_z, by_z, rounding);
  const __m256i least = _mm256_set1_epi32(-kCellsAround);
  const __m256i most = _mm256_set1_epi32(kCellsAround);
  const __m256i is_unknown =
      _mm256_or_si256(_mm256_cmpgt_epi32(least, _mm256_min_epi32(x.first, z.first)),
                      _mm256_cmpgt_epi32(_mm256_max_epi32(x.last, z.last), most));
  if (_mm256_testz_si256(is_unknown, counts) == 0) return false;
  // Lanes that do not count may be anywhere.
  const __m256i first_x = _mm256_and_si256(x.first, counts);
  const __m256i first_z = _mm256_and_si256(z.first, counts);
  if (_mm256_testc_si256(isFreeIn(ways, first_x, first_z), counts) == 0) return false;
  const __m256i last_x = _mm256_and_si256(x.last, counts);
  const __m256i last_z = _mm256_and_si256(z.last, counts);
  const __m256i is_one =
      _mm256_and_si256(_mm256_cmpeq_epi32(first_x, last_x), _mm256_cmpeq_epi32(first_z, last_z));
  if (_mm256_testc_si256(is_one, counts) != 0) return true;
  const __m256i others = _mm256_and_si256(
      _mm256_and_si256(isFreeIn(ways, first_x, last_z), isFreeIn(ways, last_x, first_z)),
      isFreeIn(ways, last_x, last_z));
  return _mm256_testc_si256(others, counts) != 0;
}

}  // namespace

bool addWaysAvx2(const std::uint16_t* rows, const EightPlaces& places, unsigned lanes,
                 EightWays& ways, AllWays& all) noexcept {
  const __m256i added = lanesOf(lanes);
  const __m256i everywhere = _mm256_set1_epi32(0x01ff'01ff);
  const __m256i nowhere = _mm256_andnot_si256(added, everywhere);
  const __m256i column = load(places.column);
  __m256i pairs[kRowPairs];
  readPairs(rows, places.row, pairs);
  __m256i is_free = everywhere;
  for (std::size_t pair = 0; pair < kRowPairs; ++pair) {
    __m256i cells = _mm256_or_si256(shifted(pairs[pair], column), nowhere);
    // There is no tenth row.
    if (pair + 1 == kRowPairs) {
      cells = _mm256_or_si256(cells, _mm256_set1_epi32(0x01ff'0000));
    }
    store(ways.rows[pair], cells);
    store(all.rows[pair], _mm256_and_si256(load(all.rows[pair]), cells));
    is_free = _mm256_and_si256(is_free, cells);
  }
  _mm256_store_ps(ways.part_x, _mm256_load_ps(places.part_x));
  _mm256_store_ps(ways.part_z, _mm256_load_ps(places.part_z));
  const __m256i counts =
      _mm256_xor_si256(_mm256_cmpeq_epi32(is_free, everywhere), _mm256_set1_epi32(-1));
  store(ways.counts, counts);
  return _mm256_testz_si256(counts, counts) == 0;
}

float takenBackAvx2(const EightWays* ways, std::size_t count, const TakeBack& back) noexcept {
  const __m256 whole = _mm256_set1_ps(1);
  __m256 least = whole;
  for (std::size_t n = 0; n < count; ++n) {
    __m256 is_free = isFree(ways[n], back.before);
    if (back.other_sign != 0) {
      const __m256 other =
          fromBorder(back.along_x ? ways[n].part_z : ways[n].part_x, back.other_sign);
      const __m256 beyond = _mm256_add_ps(_mm256_sub_ps(other, _mm256_set1_ps(back.other_back)),
                                          _mm256_set1_ps(back.margin));
      const __m256 is_behind = _mm256_cmp_ps(beyond, _mm256_setzero_ps(), _CMP_LT_OQ);
      is_free = _mm256_blendv_ps(is_free, isFree(ways[n], back.before_behind), is_behind);
    }
    const __m256 part = fromBorder(back.along_x ? ways[n].part_x : ways[n].part_z, back.sign);
    least = _mm256_min_ps(least, _mm256_blendv_ps(part, whole, is_free));
  }
  return leastOf(least);
}

bool allFreeAvx2(const EightWays* ways, std::size_t count, float by_x, float by_z,
                 float rounding) noexcept {
  for (std::size_t n = 0; n < count; ++n) {
    if (!areFree(ways[n], by_x, by_z, rounding)) return false;
  }
  return true;
}

}  // namespace galactic::simulation

#else

namespace galactic::simulation {

// hasAvx2() is false on this architecture; the symbols exist so that callers need no condition.
bool addWaysAvx2(const std::uint16_t* rows, const EightPlaces& places, unsigned lanes,
                 EightWays& ways, AllWays& all) noexcept {
  return addWaysPortable(rows, places, lanes, ways, all);
}

float takenBackAvx2(const EightWays* ways, std::size_t count, const TakeBack& back) noexcept {
  return takenBackPortable(ways, count, back);
}

bool allFreeAvx2(const EightWays* ways, std::size_t count, float by_x, float by_z,
                 float rounding) noexcept {
  return allFreePortable(ways, count, by_x, by_z, rounding);
}

}  // namespace galactic::simulation

#endif
