#include "engines/columns_by_rows.h"

#include "galactic/bake/parallel_for.h"

namespace galactic::bake {

Columns columnsByRows(const GridFrame& frame, unsigned threads,
                      const std::function<RowSpans(std::uint32_t row)>& find_row) {
  std::vector<RowSpans> rows(frame.columns_z);
  parallelFor(threads, rows.size(),
              [&](std::size_t row) { rows[row] = find_row(static_cast<std::uint32_t>(row)); });
  Columns columns;
  columns.frame = frame;
  columns.first.reserve(frame.columnCount() + 1);
  columns.first.push_back(0);
  for (RowSpans& row : rows) {
    for (const std::uint32_t count : row.counts) {
      columns.first.push_back(columns.first.back() + count);
    }
    columns.spans.insert(columns.spans.end(), row.spans.begin(), row.spans.end());
    row = {};
  }
  return columns;
}

}  // namespace galactic::bake
