#include "column_grid/grid_layout.h"

#include "galactic/schema/pack_generated.h"
#include "layout/column_cell.h"

namespace galactic::detail {

static_assert(sizeof(Span) == sizeof(schema::Span) && alignof(Span) == alignof(schema::Span),
              "spans are read in place");

ColumnGridLayout gridLayout(const schema::ColumnGrid& grid, const std::byte* file) {
  const std::uint8_t* cells = grid.cells()->Data();
  const auto offset = static_cast<std::size_t>(cells - reinterpret_cast<const std::uint8_t*>(file));
  ColumnGridLayout layout;
  layout.radius = grid.radius();
  layout.spacing = grid.spacing();
  layout.inverse_spacing = 1 / grid.spacing();
  layout.min_x = grid.min_x();
  layout.min_z = grid.min_z();
  layout.heights = {grid.heights()->lo(), grid.heights()->hi()};
  layout.quantum = grid.quantum();
  layout.inverse_quantum = 1 / grid.quantum();
  layout.columns_x = grid.columns_x();
  layout.columns_z = grid.columns_z();
  layout.tiles_x = tileCount(grid.columns_x(), kTileColumnsX);
  layout.cells = reinterpret_cast<const std::uint64_t*>(cells) + tilePadding(offset);
  layout.tile_base = grid.tile_base()->size() == 0 ? nullptr : grid.tile_base()->data();
  layout.overflow_codes =
      grid.overflow_codes()->size() == 0 ? nullptr : grid.overflow_codes()->data();
  layout.overflow_spans = reinterpret_cast<const Span*>(grid.overflow_spans()->Data());
  return layout;
}

}  // namespace galactic::detail
