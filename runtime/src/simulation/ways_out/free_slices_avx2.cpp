// Compiled for AVX2: instantiates no library templates, see column_grid_avx2.cpp.
#include "simulation/ways_out/free_slices_kernels.h"

#if defined(__x86_64__)
#include <immintrin.h>

#include "support/gather_avx2.inl"

namespace galactic::simulation {
namespace {

/// Whether values are in [0, end); false for NaN.
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

__m256i integers(const std::int32_t* from) {
  return _mm256_load_si256(reinterpret_cast<const __m256i*>(from));
}

/// Intermediate results for eight centers.
struct alignas(32) OnTheWay {
  /// Where the number of each tile stands, counted from `numbers`.
  std::int32_t number_at[kLanes];
  /// The first row around each center, in its tile.
  std::int32_t row_in_tile[kLanes];
  /// For each center the number of bits above that of its own cell.
  std::int32_t above[kLanes];
  const std::uint32_t* numbers;
  EightPlaces* places;
  /// Centers inside of slices, and those that are spheres, as bits.
  unsigned inside;
  unsigned spheres;
  /// The group's bit among those asked about.
  unsigned bit;
};

/// Finds the tiles that contain eight centers, and their places in these.
[[gnu::always_inline]] inline void findTiles(const SliceLayout& layout, const float* x,
                                             const float* y, const float* z, OnTheWay& eight) {
  const __m256 cell_x = scaled(x, layout.min_x, layout.inverse_spacing);
  const __m256 cell_z = scaled(z, layout.min_z, layout.inverse_spacing);
  const __m256 height = scaled(y, layout.lowest, layout.inverse_slice);
  const __m256 inside = _mm256_and_ps(
      _mm256_and_ps(isWithin(cell_x, layout.columns_x), isWithin(cell_z, layout.columns_z)),
      isWithin(height, layout.slices));
  // Centers outside of slices look up the first number.
  const __m256i mask = _mm256_castps_si256(inside);
  const __m256i i = _mm256_and_si256(_mm256_cvttps_epi32(cell_x), mask);
  const __m256i k = _mm256_and_si256(_mm256_cvttps_epi32(cell_z), mask);
  const __m256i slice = _mm256_and_si256(_mm256_cvttps_epi32(height), mask);
  const __m256i tile_x = _mm256_srli_epi32(i, 3);
  const __m256i column = _mm256_and_si256(i, _mm256_set1_epi32(kTileColumns - 1));
  // tileOfRow().
  const __m256i tile_z = _mm256_srli_epi32(_mm256_mullo_epi32(k, _mm256_set1_epi32(43691)), 20);
  const __m256i tile =
      _mm256_add_epi32(_mm256_mullo_epi32(tile_x, _mm256_set1_epi32(layout.tiles_z)), tile_z);
  store(eight.number_at,
        _mm256_add_epi32(_mm256_mullo_epi32(tile, _mm256_set1_epi32(layout.slice_count)), slice));
  store(eight.row_in_tile,
        _mm256_sub_epi32(k, _mm256_mullo_epi32(tile_z, _mm256_set1_epi32(kTileRows))));
  store(eight.above, _mm256_sub_epi32(_mm256_set1_epi32(31 - kCellsAround), column));
  eight.inside = bitsOf(inside);
  EightPlaces& places = *eight.places;
  store(places.column, column);
  _mm256_store_ps(places.part_x, _mm256_sub_ps(cell_x, _mm256_cvtepi32_ps(i)));
  _mm256_store_ps(places.part_z, _mm256_sub_ps(cell_z, _mm256_cvtepi32_ps(k)));
  places.inside = eight.inside;
}

/// Finds the first row around each center, counted over all tiles.
[[gnu::always_inline]] inline void findRows(const OnTheWay& eight) {
  const __m256i number = detail::gatherEight<sizeof(*eight.numbers)>(
      eight.numbers, detail::indicesAt(eight.number_at));
  static_assert(kTileStride == 1 << 6);
  store(eight.places->row,
        _mm256_add_epi32(_mm256_slli_epi32(number, 6), integers(eight.row_in_tile)));
}

/// The bits of the cells that contain eight centers. `row`: the first row around each.
[[gnu::always_inline]] inline unsigned ownBits(const std::uint16_t* rows,
                                               const detail::EightIndices& row, __m256i above) {
  const __m256i words = detail::gatherEight<sizeof(*rows)>(rows + kCellsAround, row);
  // Shifts the bit into the sign.
  return bitsOf(_mm256_castsi256_ps(_mm256_sllv_epi32(words, above)));
}

/// Finds which centers are surely free, and which surely blocked.
[[gnu::always_inline]] inline void findBits(const SliceTile* tiles, const OnTheWay& eight) {
  EightPlaces& places = *eight.places;
  const detail::EightIndices row = detail::indicesAt(places.row);
  const __m256i above = integers(eight.above);
  places.free = eight.inside & ownBits(tiles->free, row, above);
  places.blocked = eight.inside & ownBits(tiles->blocked, row, above);
}

/// Starts the search for the spheres of a group, whose centers begin at x, y and z.
[[gnu::always_inline]] inline void begin(const SliceGroup& group, const TileSet& tiles,
                                         const float* x, const float* y, const float* z,
                                         OnTheWay& eight) {
  eight.numbers = tiles.numbers + group.layout.first;
  eight.spheres = group.spheres;
  findTiles(group.layout, x, y, z, eight);
}

}  // namespace

// Run each step for all groups, because a core can queue only few loads whose addresses are not
// known yet, at most those of one group.

InSlices findPlacesAvx2(const PlacesQuery& given) noexcept {
  // Copies, so that the compiler knows that no write below changes them.
  const PlacesQuery query = given;
  const SomeGroups some = *query.some;
  OnTheWay eights[kLanes];
  std::size_t count = 0;
  for (unsigned left = some.asked; left != 0; left &= left - 1) {
    const auto n = static_cast<unsigned>(__builtin_ctz(left));
    const std::size_t first = std::size_t{n} * kLanes;
    OnTheWay& eight = eights[count++];
    eight.places = some.places + n;
    eight.bit = n;
    begin(query.groups[n], query.tiles, some.x + first, some.y + first, some.z + first, eight);
  }
  for (std::size_t n = 0; n < count; ++n) findRows(eights[n]);
  InSlices found;
  for (std::size_t n = 0; n < count; ++n) {
    findBits(query.tiles.tiles, eights[n]);
    addGroup(*eights[n].places, eights[n].spheres, eights[n].bit, found);
  }
  return found;
}

void findPlacesOfEnvsAvx2(const EnvPlacesQuery& given) noexcept {
  const EnvPlacesQuery query = given;
  const GroupsOfEnvs some = *query.some;
  OnTheWay eights[kLanes];
  for (std::uint64_t left = some.asked; left != 0;) {
    std::size_t count = 0;
    for (; left != 0 && count < kLanes; left &= left - 1) {
      const auto bit = static_cast<unsigned>(__builtin_ctzll(left));
      const std::size_t e = bit / kLanes;
      const std::size_t n = bit % kLanes;
      const std::size_t first = e * some.stride + n * kLanes;
      OnTheWay& eight = eights[count++];
      eight.places = some.places + e * some.places_stride + n;
      eight.bit = bit;
      begin(query.groups[e][n], query.tiles, some.x + first, some.y + first, some.z + first, eight);
    }
    for (std::size_t n = 0; n < count; ++n) findRows(eights[n]);
    for (std::size_t n = 0; n < count; ++n) {
      const OnTheWay& eight = eights[n];
      findBits(query.tiles.tiles, eight);
      addGroup(*eight.places, eight.spheres, eight.bit % kLanes, some.found[eight.bit / kLanes]);
    }
  }
}

}  // namespace galactic::simulation

#else

namespace galactic::simulation {

// hasAvx2() is false on this architecture; the symbols exist so that callers need no condition.
InSlices findPlacesAvx2(const PlacesQuery& query) noexcept { return findPlacesPortable(query); }

void findPlacesOfEnvsAvx2(const EnvPlacesQuery& query) noexcept { findPlacesOfEnvsPortable(query); }

}  // namespace galactic::simulation

#endif
