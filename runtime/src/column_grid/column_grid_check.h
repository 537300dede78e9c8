#pragma once
#include <cstddef>
#include <span>
#include <string>

#include "galactic/error.h"

namespace galactic {

namespace schema {
struct ColumnGrid;
}

namespace detail {

/// Checks every value of a structurally sound grid in the pack `file`: a grid that passes is safe
/// to query with any input, and keeps what schema/column_grid.fbs promises. `where` names the grid
/// in errors, all of them kInvalidInput. Runs at memory speed.
[[nodiscard]] Result<void> checkColumnGrid(const schema::ColumnGrid& grid,
                                           std::span<const std::byte> file,
                                           const std::string& where);

}  // namespace detail
}  // namespace galactic
