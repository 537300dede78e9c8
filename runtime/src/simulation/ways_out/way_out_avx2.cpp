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

/// Pairs of rows from their sphere's column on, nine bits each: what the shift brings from the
/// upper row into the lower one lies beyond its nine.
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

/// The five pairs of rows of eight spheres, a lane for each: loaded sphere by sphere and
/// transposed, which takes less time than the instructions that gather.
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
  pairs[4] =
      _mm256_setr_epi32(onePair(at[0] + kFifth), onePair(at[1] + kFifth), onePair(at[2] + kFifth),
                        onePair(at[3] + kFifth), onePair(at[4] + kFifth), onePair(at[5] + kFifth),
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

/// The least of eight numbers each.
TakenBack leastOf(__m256 x, __m256 z) {
  __m256 least = _mm256_min_ps(_mm256_unpacklo_ps(x, z), _mm256_unpackhi_ps(x, z));
  __m128 both = _mm_min_ps(_mm256_castps256_ps128(least), _mm256_extractf128_ps(least, 1));
  both = _mm_min_ps(both, _mm_movehl_ps(both, both));
  return {_mm_cvtss_f32(both), _mm_cvtss_f32(_mm_movehdup_ps(both))};
}

/// The cells along one axis that places may be in, from the spheres' own.
struct CellRanges {
  __m256i first, last;
};

CellRanges cellsAfter(const float* part, float by, float rounding) {
  if (by == 0) return {_mm256_setzero_si256(), _mm256_setzero_si256()};
  constexpr auto kAbove = static_cast<int>(kAboveCells);
  const __m256 above = _mm256_set1_ps(kAboveCells);
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

/// Where eight spheres may be after a move, the same for all: their own cells moved, and one
/// further.
struct MovedCells {
  CellRanges x, z;
  /// The cells of a sphere that is at the lower border of its own.
  WayCell low;
};

/// All bits of the lanes whose sphere is not free in all cells of its ranges, all of which are one
/// of four.
__m256i blockedInFour(const EightWays& ways, const MovedCells& cells) {
  const __m256i low_x = _mm256_set1_epi32(cells.low.x);
  const __m256i low_z = _mm256_set1_epi32(cells.low.z);
  const __m256i in_low_x = _mm256_cmpeq_epi32(cells.x.first, low_x);
  const __m256i in_low_z = _mm256_cmpeq_epi32(cells.z.first, low_z);
  const __m256i in_high_x = _mm256_cmpgt_epi32(cells.x.last, low_x);
  const __m256i in_high_z = _mm256_cmpgt_epi32(cells.z.last, low_z);
  const auto blocked = [&](__m256i in_x, __m256i in_z, int x, int z) {
    const __m256i free = _mm256_castps_si256(isFree(ways, {cells.low.x + x, cells.low.z + z}));
    return _mm256_andnot_si256(free, _mm256_and_si256(in_x, in_z));
  };
  const __m256i low_row =
      _mm256_or_si256(blocked(in_low_x, in_low_z, 0, 0), blocked(in_high_x, in_low_z, 1, 0));
  const __m256i high_row =
      _mm256_or_si256(blocked(in_low_x, in_high_z, 0, 1), blocked(in_high_x, in_high_z, 1, 1));
  return _mm256_srai_epi32(_mm256_or_si256(low_row, high_row), 31);
}

/// The same for ranges of any cells.
__m256i blockedAnywhere(const EightWays& ways, const MovedCells& cells, __m256i counts) {
  const __m256i least = _mm256_set1_epi32(-kCellsAround);
  const __m256i most = _mm256_set1_epi32(kCellsAround);
  const __m256i is_unknown =
      _mm256_or_si256(_mm256_cmpgt_epi32(least, _mm256_min_epi32(cells.x.first, cells.z.first)),
                      _mm256_cmpgt_epi32(_mm256_max_epi32(cells.x.last, cells.z.last), most));
  // Lanes that do not count, or whose cells are not known, may be anywhere.
  const __m256i looked_at = _mm256_andnot_si256(is_unknown, counts);
  const __m256i first_x = _mm256_and_si256(cells.x.first, looked_at);
  const __m256i first_z = _mm256_and_si256(cells.z.first, looked_at);
  const __m256i last_x = _mm256_and_si256(cells.x.last, looked_at);
  const __m256i last_z = _mm256_and_si256(cells.z.last, looked_at);
  const __m256i is_free = _mm256_and_si256(
      _mm256_and_si256(isFreeIn(ways, first_x, first_z), isFreeIn(ways, first_x, last_z)),
      _mm256_and_si256(isFreeIn(ways, last_x, first_z), isFreeIn(ways, last_x, last_z)));
  return _mm256_or_si256(is_unknown, _mm256_andnot_si256(is_free, looked_at));
}

bool areFree(const EightWays& ways, const CellPush& by, float rounding) {
  const __m256i counts = load(ways.counts);
  const auto lowOf = [](float by_this) {
    return static_cast<int>(by_this + kAboveCells) - static_cast<int>(kAboveCells);
  };
  const MovedCells cells{cellsAfter(ways.part_x, by.x, rounding),
                         cellsAfter(ways.part_z, by.z, rounding),
                         {lowOf(by.x), lowOf(by.z)}};
  // Rounding rarely leads further than to the next cell, and moves to the last one are rare.
  const auto beyond = [counts](const CellRanges& range, int low) {
    const __m256i is_beyond =
        _mm256_or_si256(_mm256_cmpgt_epi32(_mm256_set1_epi32(low), range.first),
                        _mm256_cmpgt_epi32(range.last, _mm256_set1_epi32(low + 1)));
    return _mm256_testz_si256(is_beyond, counts) == 0 || low < -kCellsAround || low >= kCellsAround;
  };
  const bool is_rare = beyond(cells.x, cells.low.x) || beyond(cells.z, cells.low.z);
  const __m256i blocked =
      is_rare ? blockedAnywhere(ways, cells, counts) : blockedInFour(ways, cells);
  return _mm256_testz_si256(blocked, counts) != 0;
}

/// How far places are from the nearest border of a cell after a move.
__m256 toWholeCell(const float* part, float by) {
  const __m256 cell = _mm256_add_ps(_mm256_add_ps(_mm256_load_ps(part), _mm256_set1_ps(by)),
                                    _mm256_set1_ps(kAboveCells));
  const __m256 whole = _mm256_round_ps(cell, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC);
  return _mm256_andnot_ps(_mm256_set1_ps(-0.0F), _mm256_sub_ps(cell, whole));
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

TakenBackBoth takenBackAvx2(const EightWays* ways, std::size_t count,
                            const CellMove& move) noexcept {
  const WayCell to = move.to;
  const WayCell before_x{to.x - signOf(to.x), to.z};
  const WayCell before_z{to.x, to.z - signOf(to.z)};
  const WayCell before_both{before_x.x, before_z.z};
  const __m256 whole = _mm256_set1_ps(1);
  __m256 least_x = whole;
  __m256 least_z = whole;
  for (std::size_t n = 0; n < count; ++n) {
    const __m256 x = fromBorder(ways[n].part_x, to.x);
    const __m256 z = fromBorder(ways[n].part_z, to.z);
    least_x = _mm256_min_ps(least_x, _mm256_blendv_ps(x, whole, isFree(ways[n], before_x)));
    least_z = _mm256_min_ps(least_z, _mm256_blendv_ps(z, whole, isFree(ways[n], before_z)));
  }
  const TakenBack first = leastOf(least_x, least_z);
  const __m256 margin = _mm256_set1_ps(move.margin);
  // The sign is set where a sphere is behind.
  const auto behind = [margin](__m256 to_border, float taken) {
    return _mm256_cmp_ps(_mm256_add_ps(_mm256_sub_ps(to_border, _mm256_set1_ps(taken)), margin),
                         _mm256_setzero_ps(), _CMP_LT_OQ);
  };
  least_x = least_z = whole;
  for (std::size_t n = 0; n < count; ++n) {
    const __m256 x = fromBorder(ways[n].part_x, to.x);
    const __m256 z = fromBorder(ways[n].part_z, to.z);
    const __m256 free_both = isFree(ways[n], before_both);
    const __m256 free_z =
        _mm256_blendv_ps(isFree(ways[n], before_z), free_both, behind(x, first.x));
    const __m256 free_x =
        _mm256_blendv_ps(isFree(ways[n], before_x), free_both, behind(z, first.z));
    least_x = _mm256_min_ps(least_x, _mm256_blendv_ps(x, whole, free_x));
    least_z = _mm256_min_ps(least_z, _mm256_blendv_ps(z, whole, free_z));
  }
  const TakenBack second = leastOf(least_x, least_z);
  return {{first.x, second.z}, {second.x, first.z}};
}

bool noneAtBorderAvx2(const EightWays* ways, std::size_t count, const CellPush& by,
                      float distance) noexcept {
  // What does not move along an axis may be at its border.
  const __m256 near_x = _mm256_set1_ps(by.x == 0 ? -1 : distance);
  const __m256 near_z = _mm256_set1_ps(by.z == 0 ? -1 : distance);
  __m256i is_near = _mm256_setzero_si256();
  for (std::size_t n = 0; n < count; ++n) {
    const __m256 near =
        _mm256_or_ps(_mm256_cmp_ps(toWholeCell(ways[n].part_x, by.x), near_x, _CMP_LE_OQ),
                     _mm256_cmp_ps(toWholeCell(ways[n].part_z, by.z), near_z, _CMP_LE_OQ));
    is_near =
        _mm256_or_si256(is_near, _mm256_and_si256(_mm256_castps_si256(near), load(ways[n].counts)));
  }
  return _mm256_testz_si256(is_near, is_near) != 0;
}

bool allFreeAvx2(const EightWays* ways, std::size_t count, const CellPush& by,
                 float rounding) noexcept {
  for (std::size_t n = 0; n < count; ++n) {
    if (!areFree(ways[n], by, rounding)) return false;
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

TakenBackBoth takenBackAvx2(const EightWays* ways, std::size_t count,
                            const CellMove& move) noexcept {
  return takenBackPortable(ways, count, move);
}

bool noneAtBorderAvx2(const EightWays* ways, std::size_t count, const CellPush& by,
                      float distance) noexcept {
  return noneAtBorderPortable(ways, count, by, distance);
}

bool allFreeAvx2(const EightWays* ways, std::size_t count, const CellPush& by,
                 float rounding) noexcept {
  return allFreePortable(ways, count, by, rounding);
}

}  // namespace galactic::simulation

#endif
