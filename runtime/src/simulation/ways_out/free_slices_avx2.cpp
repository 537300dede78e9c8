// Compiled for AVX2: instantiates no library templates, see column_grid_avx2.cpp.
#include "simulation/ways_out/free_slices_kernels.h"

#if defined(__x86_64__)
#include <immintrin.h>

namespace galactic::simulation {
namespace {

/// From 0 up to `end`, not NaN.
__m256 isWithin(__m256 value, float end) {
  return _mm256_and_ps(_mm256_cmp_ps(value, _mm256_setzero_ps(), _CMP_GE_OQ),
                       _mm256_cmp_ps(value, _mm256_set1_ps(end), _CMP_LT_OQ));
}

__m256 scaled(const float* from, float origin, float scale) {
  return _mm256_mul_ps(_mm256_sub_ps(_mm256_loadu_ps(from), _mm256_set1_ps(origin)),
                       _mm256_set1_ps(scale));
}

unsigned bitsOf(__m256 mask) { return static_cast<unsigned>(_mm256_movemask_ps(mask)); }

void store(std::int32_t* to, __m256i value) {
  _mm256_store_si256(reinterpret_cast<__m256i*>(to), value);
}

/// Eight words from rows of bits. See resting_objects_avx2.cpp for why the gather is given a zero.
template <int kScale, class Element>
__m256i gather(const Element* from, __m256i at, __m256 inside) {
  return _mm256_mask_i32gather_epi32(_mm256_setzero_si256(), reinterpret_cast<const int*>(from), at,
                                     _mm256_castps_si256(inside), kScale);
}

/// The bits of the cells in which eight centers are, zero outside. `row`: the first around each.
unsigned ownBits(const std::uint16_t* rows, __m256i row, __m256i column, __m256 inside) {
  const __m256i words = gather<2>(rows + kCellsAround, row, inside);
  // Into the sign.
  const __m256i above = _mm256_sub_epi32(_mm256_set1_epi32(31 - kCellsAround), column);
  return bitsOf(_mm256_castsi256_ps(_mm256_sllv_epi32(words, above)));
}

/// The places of eight centers.
void findEight(const SliceLayout& layout, const TileSet& tiles, const float* x, const float* y,
               const float* z, EightPlaces& places) {
  const __m256 cell_x = scaled(x, layout.min_x, layout.inverse_spacing);
  const __m256 cell_z = scaled(z, layout.min_z, layout.inverse_spacing);
  const __m256 height = scaled(y, layout.lowest, layout.inverse_slice);
  const __m256 inside = _mm256_and_ps(
      _mm256_and_ps(isWithin(cell_x, layout.columns_x), isWithin(cell_z, layout.columns_z)),
      isWithin(height, layout.slices));
  const __m256i mask = _mm256_castps_si256(inside);
  const __m256i i = _mm256_and_si256(_mm256_cvttps_epi32(cell_x), mask);
  const __m256i k = _mm256_and_si256(_mm256_cvttps_epi32(cell_z), mask);
  const __m256i slice = _mm256_and_si256(_mm256_cvttps_epi32(height), mask);
  const __m256 part_x = _mm256_sub_ps(cell_x, _mm256_cvtepi32_ps(i));
  const __m256 part_z = _mm256_sub_ps(cell_z, _mm256_cvtepi32_ps(k));
  const __m256i tile_x = _mm256_srli_epi32(i, 3);
  const __m256i column = _mm256_and_si256(i, _mm256_set1_epi32(kTileColumns - 1));
  // tileOfRow().
  const __m256i tile_z = _mm256_srli_epi32(_mm256_mullo_epi32(k, _mm256_set1_epi32(43691)), 20);
  const __m256i row_in_tile =
      _mm256_sub_epi32(k, _mm256_mullo_epi32(tile_z, _mm256_set1_epi32(kTileRows)));
  const __m256i tile =
      _mm256_add_epi32(_mm256_mullo_epi32(tile_x, _mm256_set1_epi32(layout.tiles_z)), tile_z);
  const __m256i at =
      _mm256_add_epi32(_mm256_mullo_epi32(tile, _mm256_set1_epi32(layout.slice_count)), slice);
  const __m256i number = gather<4>(tiles.numbers + layout.first, at, inside);
  const __m256i row = _mm256_add_epi32(_mm256_slli_epi32(number, 6), row_in_tile);
  store(places.row, row);
  store(places.column, column);
  _mm256_store_ps(places.part_x, part_x);
  _mm256_store_ps(places.part_z, part_z);
  places.inside = bitsOf(inside);
  places.free = ownBits(tiles.tiles->free, row, column, inside);
  places.blocked = ownBits(tiles.tiles->blocked, row, column, inside);
}

}  // namespace

InSlices findPlacesAvx2(const PlacesQuery& given) noexcept {
  // Copies: nothing that is written below can change them.
  const PlacesQuery query = given;
  const SomeGroups some = *query.some;
  InSlices found;
  for (unsigned left = some.asked; left != 0; left &= left - 1) {
    const auto n = static_cast<std::size_t>(__builtin_ctz(left));
    const std::size_t first = n * kLanes;
    const SliceGroup& group = query.groups[n];
    EightPlaces& places = some.places[n];
    findEight(group.layout, query.tiles, some.x + first, some.y + first, some.z + first, places);
    addGroup(places, group.spheres, n, found);
  }
  return found;
}

}  // namespace galactic::simulation

#else

namespace galactic::simulation {

// hasAvx2() is false on this architecture; the symbol exists so that callers need no condition.
InSlices findPlacesAvx2(const PlacesQuery& query) noexcept { return findPlacesPortable(query); }

}  // namespace galactic::simulation

#endif
