// Queries a column grid for eight centers at a time. Included by the files that are compiled for
// AVX2 and need it, after column_grid_kernels.h and immintrin.h. No library templates here: see
// column_grid_avx2.cpp.
#include "support/gather_avx2.inl"

namespace galactic::detail {
namespace {

constexpr std::size_t kLanes = 8;
constexpr int kAllTrue = -1;

/// The grid's numbers, one copy per lane.
struct Lanes {
  __m256 min_x, min_z, inverse_spacing, columns_x, columns_z;
  __m256 lowest, highest, inverse_quantum;
  __m256i tiles_x;
};

/// The query results of eight centers: masks (all bits of a lane set), codes as floats.
struct Found {
  __m256 inside, not_a_number, overflow, free, code, lo, hi;
  __m256i upper_half;
};

inline Lanes broadcast(const ColumnGridLayout& grid) {
  return {_mm256_set1_ps(grid.min_x),
          _mm256_set1_ps(grid.min_z),
          _mm256_set1_ps(grid.inverse_spacing),
          _mm256_set1_ps(static_cast<float>(grid.columns_x)),
          _mm256_set1_ps(static_cast<float>(grid.columns_z)),
          _mm256_set1_ps(grid.heights.lo),
          _mm256_set1_ps(grid.heights.hi),
          _mm256_set1_ps(grid.inverse_quantum),
          _mm256_set1_epi32(static_cast<int>(grid.tiles_x))};
}

inline __m256 clearOf(__m256 distance, __m256 margin) {
  return _mm256_max_ps(_mm256_sub_ps(distance, margin), _mm256_setzero_ps());
}

inline __m256 within(__m256 value, __m256 lo, __m256 hi) {
  return _mm256_and_ps(_mm256_cmp_ps(value, lo, _CMP_GE_OQ), _mm256_cmp_ps(value, hi, _CMP_LE_OQ));
}

inline __m256 withinHalfOpen(__m256 value, __m256 end) {
  return _mm256_and_ps(_mm256_cmp_ps(value, _mm256_setzero_ps(), _CMP_GE_OQ),
                       _mm256_cmp_ps(value, end, _CMP_LT_OQ));
}

inline __m256 lowCode(__m256i half) {
  return _mm256_cvtepi32_ps(_mm256_and_si256(half, _mm256_set1_epi32(0xffff)));
}

inline __m256 highCode(__m256i half) { return _mm256_cvtepi32_ps(_mm256_srli_epi32(half, 16)); }

/// The bases of eight tiles, in codes. Loads have 32 bits, two bases: the pair that ends with the
/// wanted base, or begins with it for tile 0, so that nothing outside the array is read. Needs at
/// least two tiles.
inline __m256 baseCodes(const std::uint16_t* tile_base, __m256i tile) {
  const __m256i is_first = _mm256_cmpeq_epi32(tile, _mm256_setzero_si256());
  const __m256i pair = _mm256_sub_epi32(tile, _mm256_andnot_si256(is_first, _mm256_set1_epi32(1)));
  const __m256i bases = gatherEight<sizeof(*tile_base)>(tile_base, pair);
  const __m256i shift = _mm256_andnot_si256(is_first, _mm256_set1_epi32(16));
  const __m256i base = _mm256_and_si256(_mm256_srlv_epi32(bases, shift), _mm256_set1_epi32(0xffff));
  return _mm256_cvtepi32_ps(_mm256_slli_epi32(base, 10));  // kCodesPerTileBase = 1 << 10
}

/// Eight cells, as their lower and their upper 32 bits in the order of the indices.
struct CellHalves {
  __m256i lower, upper;
};

inline CellHalves cellsAt(const std::uint64_t* cells, __m256i index) {
  const TwoOfEight halves =
      gatherTwoOfEight<2>(reinterpret_cast<const std::int32_t*>(cells), index);
  return {_mm256_castps_si256(halves.first), _mm256_castps_si256(halves.second)};
}

inline Found find(const ColumnGridLayout& grid, const Lanes& lanes, __m256 x, __m256 y, __m256 z) {
  const __m256 cell_x = _mm256_mul_ps(_mm256_sub_ps(x, lanes.min_x), lanes.inverse_spacing);
  const __m256 cell_z = _mm256_mul_ps(_mm256_sub_ps(z, lanes.min_z), lanes.inverse_spacing);
  Found found;
  found.inside = _mm256_and_ps(_mm256_and_ps(withinHalfOpen(cell_x, lanes.columns_x),
                                             withinHalfOpen(cell_z, lanes.columns_z)),
                               within(y, lanes.lowest, lanes.highest));
  found.not_a_number =
      _mm256_or_ps(_mm256_cmp_ps(x, y, _CMP_UNORD_Q), _mm256_cmp_ps(z, z, _CMP_UNORD_Q));

  // Lanes outside read cell 0; their answer is replaced.
  const __m256i mask = _mm256_castps_si256(found.inside);
  const __m256i i = _mm256_and_si256(_mm256_cvttps_epi32(cell_x), mask);
  const __m256i k = _mm256_and_si256(_mm256_cvttps_epi32(cell_z), mask);
  const __m256i tile = _mm256_add_epi32(_mm256_mullo_epi32(_mm256_srli_epi32(k, 1), lanes.tiles_x),
                                        _mm256_srli_epi32(i, 2));
  const __m256i in_tile =
      _mm256_or_si256(_mm256_slli_epi32(_mm256_and_si256(k, _mm256_set1_epi32(1)), 2),
                      _mm256_and_si256(i, _mm256_set1_epi32(3)));
  const CellHalves cells =
      cellsAt(grid.cells, _mm256_or_si256(_mm256_slli_epi32(tile, 3), in_tile));
  found.upper_half = cells.upper;
  found.overflow = _mm256_and_ps(found.inside, _mm256_castsi256_ps(_mm256_cmpeq_epi32(
                                                   cells.lower, _mm256_set1_epi32(kAllTrue))));

  found.code = _mm256_mul_ps(_mm256_sub_ps(y, lanes.lowest), lanes.inverse_quantum);
  if (grid.tile_base != nullptr) {
    found.code = _mm256_sub_ps(found.code, baseCodes(grid.tile_base, tile));
  }
  const __m256 lo1 = lowCode(cells.upper);
  const __m256 hi1 = highCode(cells.upper);
  const __m256 in_second = within(found.code, lo1, hi1);
  found.lo = _mm256_blendv_ps(lowCode(cells.lower), lo1, in_second);
  found.hi = _mm256_blendv_ps(highCode(cells.lower), hi1, in_second);
  found.free = _mm256_and_ps(found.inside, within(found.code, found.lo, found.hi));
  return found;
}

/// Bit mask of the lanes that are free in cells that keep their spans in the overflow block.
inline unsigned freeInOverflow(const ColumnGridLayout& grid, __m256 y, const Found& found) {
  auto lanes = static_cast<unsigned>(_mm256_movemask_ps(found.overflow));
  if (lanes == 0) return 0;
  alignas(32) std::uint32_t start[kLanes];
  alignas(32) float heights[kLanes];
  _mm256_store_si256(reinterpret_cast<__m256i*>(start), found.upper_half);
  _mm256_store_ps(heights, y);
  unsigned free = 0;
  while (lanes != 0) {
    const auto lane = static_cast<std::size_t>(__builtin_ctz(lanes));
    lanes &= lanes - 1;
    if (isFreeInOverflow(grid, start[lane], heights[lane])) free |= 1U << lane;
  }
  return free;
}

/// Whether baseCodes() may be used: the base of a single tile is only half of what it reads.
inline bool readsWholePairs(const ColumnGridLayout& grid) {
  const bool one_tile = grid.tiles_x == 1 && grid.columns_z <= 2;
  return grid.tile_base == nullptr || !one_tile;
}

/// Bit mask of the lanes that are not free.
inline unsigned notFreeLanes(const ColumnGridLayout& grid, const Lanes& lanes, __m256 x, __m256 y,
                             __m256 z) {
  const Found found = find(grid, lanes, x, y, z);
  constexpr unsigned kAllLanes = 0xff;
  const auto not_free = static_cast<unsigned>(_mm256_movemask_ps(found.free)) ^ kAllLanes;
  return not_free == 0 ? 0 : not_free & ~freeInOverflow(grid, y, found);
}

}  // namespace
}  // namespace galactic::detail
