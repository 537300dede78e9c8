#pragma once
#include <cstdint>

#include "simulation/collision/sphere_batch.h"

namespace galactic::simulation {

/// Slices know the cells around a sphere's own up to this many in each direction.
inline constexpr int kCellsAround = 4;

/// The next tile begins after this many columns along X, and rows along Z. It repeats the last ones
/// of the previous tile, so that all cells around a center lie in one tile.
inline constexpr std::uint32_t kTileColumns = 8;
inline constexpr std::uint32_t kTileRows = 24;

/// The cells of one slice that are surely free, and those that are surely blocked: rows along Z of
/// one bit for each of sixteen columns along X. One cache line each.
struct alignas(64) SliceTile {
  static constexpr std::uint32_t kRows = 32;
  std::uint16_t free[kRows];
  std::uint16_t blocked[kRows];
};
/// Rows of 16 bits from one tile to the next.
inline constexpr std::int32_t kTileStride = sizeof(SliceTile) / sizeof(std::uint16_t);

/// The slices of one floor and radius, as plain data for the kernels.
struct SliceLayout {
  float min_x = 0, min_z = 0, inverse_spacing = 0;
  float columns_x = 0, columns_z = 0;
  float lowest = 0, inverse_slice = 0, slices = 0;
  std::int32_t slice_count = 0;
  /// Tiles along Z.
  std::int32_t tiles_z = 0;
  /// The number of the tile of slice s at tile (i, k) stands at first + (i * tiles_z + k) *
  /// slice_count + s.
  std::uint64_t first = 0;
};

/// k / kTileRows for k < 2^16, with operations that vectors have, too.
[[nodiscard]] constexpr std::uint32_t tileOfRow(std::uint32_t k) { return (k * 43691U) >> 20U; }
static_assert(tileOfRow(65535) == 65535 / kTileRows && tileOfRow(65519) == 65519 / kTileRows);

/// Distinct tiles, and the numbers that refer to them. All cells of tile 0 are free.
struct TileSet {
  const std::uint32_t* numbers = nullptr;
  const SliceTile* tiles = nullptr;
};

/// The places of eight centers among cells and slices; the values of centers outside have no
/// meaning.
struct alignas(64) EightPlaces {
  /// The first of the nine rows around each center, counted from the first tile.
  std::int32_t row[kLanes] = {};
  /// Each center's column in its tile.
  std::int32_t column[kLanes] = {};
  /// Each center's position in its cell, from 0 to 1.
  float part_x[kLanes] = {};
  float part_z[kLanes] = {};
  /// As bits: the centers that are inside of slices, surely free, and surely blocked.
  unsigned inside = 0;
  unsigned free = 0;
  unsigned blocked = 0;
};

/// The slices of one floor for a group of eight, and which of the eight are spheres, as bits.
struct SliceGroup {
  SliceLayout layout;
  unsigned spheres = 0;
};

/// Some of up to eight consecutive groups of spheres. All arrays begin with the first group.
struct SomeGroups {
  const float* x = nullptr;
  const float* y = nullptr;
  const float* z = nullptr;
  /// The groups that are asked about, as bits.
  unsigned asked = 0;
  /// Results for those groups.
  EightPlaces* places = nullptr;
};

/// A query for the places of the spheres of some groups.
struct PlacesQuery {
  /// Begins with the first group.
  const SliceGroup* groups = nullptr;
  TileSet tiles;
  const SomeGroups* some = nullptr;
};

/// The slices' answers about up to eight groups.
struct InSlices {
  /// One bit for each sphere that is surely blocked.
  std::uint64_t blocked = 0;
  /// One bit for each sphere that slices know neither to be free nor to be blocked.
  std::uint64_t unknown = 0;
};

/// The most envs in one query.
inline constexpr std::size_t kEnvsAsked = 8;

/// Some of up to eight groups of each of up to kEnvsAsked envs. All arrays begin with the first
/// group of the first env.
struct GroupsOfEnvs {
  const float* x = nullptr;
  const float* y = nullptr;
  const float* z = nullptr;
  /// Floats from one env to the next.
  std::size_t stride = 0;
  /// The groups that are asked about: bit kLanes * e + n is group n of env e.
  std::uint64_t asked = 0;
  /// Results for those groups.
  EightPlaces* places = nullptr;
  std::size_t places_stride = 0;
  /// The slices' answers are added to these, one per env.
  InSlices* found = nullptr;
};

struct EnvPlacesQuery {
  /// The first group of each env.
  const SliceGroup* const* groups = nullptr;
  TileSet tiles;
  const GroupsOfEnvs* some = nullptr;
};

/// Adds the answer about a group, number `n` of those that are asked about. Whether something is
/// unknown is unpredictable, so there is no branch. Always inlined, so that no copy built for AVX2
/// can become the one that the linker keeps for all processors.
[[gnu::always_inline]] inline void addGroup(const EightPlaces& places, unsigned spheres,
                                            std::size_t n, InSlices& found) {
  found.blocked |= std::uint64_t{spheres & places.blocked} << (n * kLanes);
  found.unknown |= std::uint64_t{spheres & ~(places.free | places.blocked)} << (n * kLanes);
}

/// Find the places of groups of eight centers. Both versions do the same operations, and agree bit
/// for bit.
InSlices findPlacesPortable(const PlacesQuery& query) noexcept;
InSlices findPlacesAvx2(const PlacesQuery& query) noexcept;
void findPlacesOfEnvsPortable(const EnvPlacesQuery& query) noexcept;
void findPlacesOfEnvsAvx2(const EnvPlacesQuery& query) noexcept;

}  // namespace galactic::simulation
