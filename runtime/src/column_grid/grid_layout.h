#pragma once
#include <cstddef>

#include "galactic/column_grid.h"

namespace galactic {

namespace schema {
struct ColumnGrid;
}

namespace detail {

/// Where the parts of a pack's column grid lie. `file` is the first byte of the pack that holds
/// `grid`: the tiles begin at a multiple of 64 bytes in the file. Reads only the table's fields, no
/// cells; if the grid was not checked, the pointers may lead anywhere.
[[nodiscard]] ColumnGridLayout gridLayout(const schema::ColumnGrid& grid, const std::byte* file);

}  // namespace detail
}  // namespace galactic
