#include "column_grid/column_grid_check.h"

#include <cmath>

#include "check/common_check.h"
#include "check/offence.h"
#include "column_grid/cell_check.h"
#include "column_grid/grid_layout.h"
#include "galactic/schema/pack_generated.h"
#include "layout/column_cell.h"
#include "support/try.h"

namespace galactic::detail {
namespace {

/// Vectors of a grid start at multiples of this in the file (force_align in the schema).
constexpr std::size_t kVectorAlignment = 32;
/// Grids extend by a margin beyond the mesh, which reaches kFarthest.
constexpr float kFarthestGrid = 1000;

bool isInGrid(float meters) { return std::fabs(meters) <= kFarthestGrid; }

/// Where the last column ends, meters.
float endOf(float min, std::uint32_t columns, float spacing) {
  return min + static_cast<float>(columns) * spacing;
}

Result<void> checkFrame(const schema::ColumnGrid& grid, const std::string& where) {
  Offence offence(where);
  offence.require(isLength(grid.radius()), "radius", "is {} m, expected a number above 0",
                  grid.radius());
  offence.require(isLength(grid.spacing()) && grid.spacing() >= kLeastSpacing, "spacing",
                  "is {} m, expected a length of at least {} m", grid.spacing(), kLeastSpacing);
  offence.require(grid.radius() >= 0.5F * grid.spacing(), "radius",
                  "is {} m, expected at least half the spacing of {} m", grid.radius(),
                  grid.spacing());
  offence.require(isLength(grid.quantum()), "quantum", "is {} m, expected a number above 0",
                  grid.quantum());
  offence.require(isInGrid(grid.min_x()), "min_x", "is {} m, expected up to {} m", grid.min_x(),
                  kFarthestGrid);
  offence.require(isInGrid(grid.min_z()), "min_z", "is {} m, expected up to {} m", grid.min_z(),
                  kFarthestGrid);
  offence.require(grid.columns_x() >= 1 && grid.columns_x() <= kMaxCells, "columns_x",
                  "is {}, expected 1 to {}", grid.columns_x(), kMaxCells);
  offence.require(grid.columns_z() >= 1 && grid.columns_z() <= kMaxCells, "columns_z",
                  "is {}, expected 1 to {}", grid.columns_z(), kMaxCells);
  offence.require(grid.coverage() <= schema::Coverage::MAX, "coverage",
                  "is {}, expected a value up to {}", static_cast<unsigned>(grid.coverage()),
                  static_cast<unsigned>(schema::Coverage::MAX));
  const schema::Span* heights = grid.heights();
  offence.require(heights != nullptr, "heights",
                  "are missing, expected the grid's range of heights");
  if (offence.found()) return offence.result();
  offence.require(
      isInGrid(heights->lo()) && isInGrid(heights->hi()) && heights->lo() <= heights->hi(),
      "heights", "are {} to {} m, expected ascending heights of up to {} m", heights->lo(),
      heights->hi(), kFarthestGrid);
  return offence.result();
}

template <class Vector>
void requireAligned(Offence& offence, const Vector& vector, const std::byte* file,
                    const char* field) {
  const auto offset =
      static_cast<std::size_t>(vector.Data() - reinterpret_cast<const std::uint8_t*>(file));
  offence.require(vector.size() == 0 || offset % kVectorAlignment == 0, field,
                  "starts at byte {} of the file, expected a multiple of {}", offset,
                  kVectorAlignment);
}

/// Checks the sizes and places of the grid's vectors, without which no cell can be read safely.
Result<void> checkVectors(const schema::ColumnGrid& grid, const std::byte* file,
                          const std::string& where) {
  Offence offence(where);
  const std::uint64_t cells = cellCount(grid.columns_x(), grid.columns_z());
  offence.require(cells <= kMaxCells, "columns_x",
                  "times columns_z needs {} cells, expected up to {}", cells, kMaxCells);
  offence.require(grid.cells()->size() == cells + kTilePaddingCells, "cells",
                  "has {} elements, expected {} for {} x {} columns", grid.cells()->size(),
                  cells + kTilePaddingCells, grid.columns_x(), grid.columns_z());
  const std::uint64_t tiles = cells / kCellsPerTile;
  offence.require(grid.tile_base()->size() == 0 || grid.tile_base()->size() == tiles, "tile_base",
                  "has {} elements, expected none or {}, one per tile", grid.tile_base()->size(),
                  tiles);
  offence.require(isInGrid(endOf(grid.min_x(), grid.columns_x(), grid.spacing())) &&
                      isInGrid(endOf(grid.min_z(), grid.columns_z(), grid.spacing())),
                  "columns_x", "and columns_z are {} and {}, expected an end within {} m",
                  grid.columns_x(), grid.columns_z(), kFarthestGrid);
  requireAligned(offence, *grid.cells(), file, "cells");
  requireAligned(offence, *grid.tile_base(), file, "tile_base");
  requireAligned(offence, *grid.overflow_codes(), file, "overflow_codes");
  requireAligned(offence, *grid.overflow_spans(), file, "overflow_spans");
  const bool tall = grid.tile_base()->size() != 0;
  offence.require(tall || grid.overflow_spans()->size() == 0, "overflow_spans",
                  "has {} elements in a grid without tile bases, expected none: overflow_codes has "
                  "its spans",
                  grid.overflow_spans()->size());
  offence.require(!tall || grid.overflow_codes()->size() == 0, "overflow_codes",
                  "has {} elements in a grid with tile bases, expected none: overflow_spans has "
                  "its spans",
                  grid.overflow_codes()->size());
  return offence.result();
}

Result<void> checkCastCheck(const schema::CastCheck& check, const std::string& where) {
  Offence offence(where + ".statistics.cast_check");
  offence.require(check.columns_differing() <= check.columns(), "columns_differing",
                  "is {}, expected at most the {} columns replayed", check.columns_differing(),
                  check.columns());
  constexpr const char* kWanted = "is {} m, expected a finite length of 0 or more";
  offence.require(isAmount(check.compared()), "compared", kWanted, check.compared());
  offence.require(isAmount(check.method()), "method", kWanted, check.method());
  offence.require(isAmount(check.ties()), "ties", kWanted, check.ties());
  offence.require(isAmount(check.errors()), "errors", kWanted, check.errors());
  return offence.result();
}

Result<void> checkStatistics(const schema::GridStatistics& statistics, const CellTotals& totals,
                             const std::string& where) {
  Offence offence(where);
  offence.require(statistics.spans() == totals.spans, "statistics.spans",
                  "is {}, expected the {} spans that the cells hold", statistics.spans(),
                  totals.spans);
  offence.require(statistics.max_spans_per_column() == totals.max_spans_per_column,
                  "statistics.max_spans_per_column", "is {}, expected the {} that the cells hold",
                  statistics.max_spans_per_column(), totals.max_spans_per_column);
  if (statistics.regions() != nullptr) {
    for (flatbuffers::uoffset_t n = 0; n < statistics.regions()->size() && !offence.found(); ++n) {
      const schema::RegionStatistics& region = *statistics.regions()->Get(n);
      offence.require(region.region() <= schema::Region::MAX,
                      fmt::format("statistics.regions[{}].region", n),
                      "is {}, expected a value up to {}", static_cast<unsigned>(region.region()),
                      static_cast<unsigned>(schema::Region::MAX));
      offence.require(isAmount(region.volume()), fmt::format("statistics.regions[{}].volume", n),
                      "is {} m3, expected a finite volume of 0 or more", region.volume());
    }
  }
  if (statistics.cast_check() != nullptr) {
    offence.require(checkCastCheck(*statistics.cast_check(), where));
  }
  return offence.result();
}

}  // namespace

Result<void> checkColumnGrid(const schema::ColumnGrid& grid, std::span<const std::byte> file,
                             const std::string& where) {
  if (auto checked = checkFrame(grid, where); !checked) return checked;
  if (auto checked = checkVectors(grid, file.data(), where); !checked) return checked;
  const CellBlock block{.layout = gridLayout(grid, file.data()),
                        .stored_cells = {grid.cells()->data(), grid.cells()->size()},
                        .overflow_elements = std::size_t{grid.overflow_codes()->size()} +
                                             grid.overflow_spans()->size()};
  ASSIGN_OR_RETURN(const CellTotals totals, checkCells(block, where));
  return checkStatistics(*grid.statistics(), totals, where);
}

}  // namespace galactic::detail
