#pragma once
#include <cstdint>

#include "simulation/collision/sphere_batch.h"

namespace galactic::simulation {

/// Cells in each direction around a sphere's own of which slices tell.
inline constexpr int kCellsAround = 4;

/// Columns and rows of columns after which the next tile begins: it holds the last ones of the tile
/// before, too, so that all cells around a center lie in one.
inline constexpr std::uint32_t kTileColumns = 8;
inline constexpr std::uint32_t kTileRows = 24;

/// Which cells of one slice are surely free, and surely blocked: rows along Z of sixteen columns
/// along X, a bit each. A line of the cache each.
struct alignas(64) SliceTile {
  static constexpr std::uint32_t kRows = 32;
  std::uint16_t free[kRows];
  std::uint16_t blocked[kRows];
};
/// Rows of 16 bits from one tile to the next.
inline constexpr std::int32_t kTileStride = sizeof(SliceTile) / sizeof(std::uint16_t);

/// The slices of one floor and radius: plain data for the kernels.
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

/// k / kTileRows for k < 2^16, in operations that vectors have, too.
[[nodiscard]] constexpr std::uint32_t tileOfRow(std::uint32_t k) { return (k * 43691U) >> 20U; }
static_assert(tileOfRow(65535) == 65535 / kTileRows && tileOfRow(65519) == 65519 / kTileRows);

/// Tiles of which there is one of each kind. All cells of the first one are free.
struct TileSet {
  const std::uint32_t* numbers = nullptr;
  const SliceTile* tiles = nullptr;
};

/// Where eight centers are among cells and slices; of those outside, nothing counts.
struct alignas(64) EightPlaces {
  /// The first of the nine rows around a center, counted from the first tile.
  std::int32_t row[kLanes] = {};
  /// Its column in the tile.
  std::int32_t column[kLanes] = {};
  /// Where in its cell a center is, from 0 to 1.
  float part_x[kLanes] = {};
  float part_z[kLanes] = {};
  /// As bits: what is inside of slices, surely free, and surely blocked.
  unsigned inside = 0;
  unsigned free = 0;
  unsigned blocked = 0;
};

/// The slices of one floor that eight spheres ask, and which of the eight are spheres, as bits.
struct SliceGroup {
  SliceLayout layout;
  unsigned spheres = 0;
};

/// Some of up to eight groups of spheres one after the other. All arrays begin with the first
/// group.
struct SomeGroups {
  const float* x = nullptr;
  const float* y = nullptr;
  const float* z = nullptr;
  /// Which of them are asked about, as bits.
  unsigned asked = 0;
  /// Results, of those groups.
  EightPlaces* places = nullptr;
};

/// Asks where the spheres of some groups are.
struct PlacesQuery {
  /// Of the first group.
  const SliceGroup* groups = nullptr;
  TileSet tiles;
  const SomeGroups* some = nullptr;
};

/// What slices say of up to eight groups.
struct InSlices {
  /// One bit for each sphere that is surely blocked.
  std::uint64_t blocked = 0;
  /// One bit for each sphere of which slices do not know.
  std::uint64_t unknown = 0;
};

/// Envs that are asked about at a time.
inline constexpr std::size_t kEnvsAsked = 8;

/// Some of up to eight groups of each of up to kEnvsAsked envs. All arrays begin with the first
/// group of the first env.
struct GroupsOfEnvs {
  const float* x = nullptr;
  const float* y = nullptr;
  const float* z = nullptr;
  /// Floats from one env to the next.
  std::size_t stride = 0;
  /// Which of them are asked about: bit kLanes * e + n is group n of env e.
  std::uint64_t asked = 0;
  /// Results, of those groups.
  EightPlaces* places = nullptr;
  std::size_t places_stride = 0;
  /// To which is added what slices say of each env.
  InSlices* found = nullptr;
};

struct EnvPlacesQuery {
  /// Of each env, its first group.
  const SliceGroup* const* groups = nullptr;
  TileSet tiles;
  const GroupsOfEnvs* some = nullptr;
};

/// Adds what is said of a group, number `n` of those that are asked about. Nobody can guess whether
/// something is unknown: a number, and no branch. Inlined everywhere: a copy built for AVX2 must
/// not become that of all.
[[gnu::always_inline]] inline void addGroup(const EightPlaces& places, unsigned spheres,
                                            std::size_t n, InSlices& found) {
  found.blocked |= std::uint64_t{spheres & places.blocked} << (n * kLanes);
  found.unknown |= std::uint64_t{spheres & ~(places.free | places.blocked)} << (n * kLanes);
}

/// Finds the places of eights of centers. Both do the same operations, and agree bit for bit.
InSlices findPlacesPortable(const PlacesQuery& query) noexcept;
InSlices findPlacesAvx2(const PlacesQuery& query) noexcept;
void findPlacesOfEnvsPortable(const EnvPlacesQuery& query) noexcept;
void findPlacesOfEnvsAvx2(const EnvPlacesQuery& query) noexcept;

}  // namespace galactic::simulation
