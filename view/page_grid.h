#pragma once
#include "galactic/column_grid.h"
#include "view/page_data.h"

namespace galactic {

/// Writes a column grid into the data of a page, as an object of an array. Spans are whole numbers
/// of `quantum` above `low`: exact where the whole grid fits into 65535 quanta of the pack.
void writeGrid(const ColumnGrid& grid, JsonWriter& json, PageData& data);

}  // namespace galactic
