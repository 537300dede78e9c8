#pragma once
#include <cstdint>

#include "simulation/collision/sphere_batch.h"

namespace galactic::simulation {

/// Cells in each direction around a sphere's own of which slices tell.
inline constexpr int kCellsAround = 4;

/// Columns after which a strip begins; the strip before it holds the first ones, too.
inline constexpr std::uint32_t kStripColumns = 8;

/// The slices of one floor and radius: plain data for the kernels.
struct SliceLayout {
  float min_x = 0, min_z = 0, inverse_spacing = 0;
  float columns_x = 0, columns_z = 0;
  float lowest = 0, inverse_slice = 0, slices = 0;
  /// Slices of a strip.
  std::int32_t slice_count = 0;
  /// Rows of a slice: kCellsAround zeros, one for each column along Z, and zeros.
  std::int32_t row_count = 0;
  std::uint64_t first = 0;
};

/// Where eight centers are among cells and slices; of those outside, nothing counts.
struct alignas(32) EightPlaces {
  /// The first of the nine rows around a center, of its layout's.
  std::int32_t row[kLanes] = {};
  /// Its column in the strip.
  std::int32_t column[kLanes] = {};
  /// Where in its cell a center is, from 0 to 1.
  float part_x[kLanes] = {};
  float part_z[kLanes] = {};
  /// As bits: what is inside of slices, surely free, and surely blocked.
  unsigned inside = 0;
  unsigned free = 0;
  unsigned blocked = 0;
};

/// All slices of a layout: the rows that tell what is free, and as many that tell what is blocked.
struct SliceRows {
  const std::uint16_t* free = nullptr;
  const std::uint16_t* blocked = nullptr;
};

/// Finds the places of eight centers. Both do the same operations, and agree bit for bit.
void findPlacesPortable(const SliceLayout& layout, const SliceRows& rows, const float* x,
                        const float* y, const float* z, EightPlaces& places) noexcept;
void findPlacesAvx2(const SliceLayout& layout, const SliceRows& rows, const float* x,
                    const float* y, const float* z, EightPlaces& places) noexcept;

}  // namespace galactic::simulation
