#include "column_grid/assemble_columns.h"

#include <algorithm>

#include "galactic/bake/parallel_for.h"

namespace galactic::bake {

ExactColumns assembleColumns(
    const GridFrame& frame, unsigned threads, std::uint32_t strip_count,
    const std::function<void(std::uint32_t index, ColumnStrip& strip)>& fill) {
  struct StripResult {
    std::vector<std::uint32_t> counts;
    std::vector<Span> spans;
    std::uint64_t merged_gaps = 0;
  };
  std::vector<StripResult> strips(strip_count);
  parallelFor(threads, strip_count, [&](std::size_t task) {
    const auto index = static_cast<std::uint32_t>(task);
    const std::uint32_t first_row = index * kRowsPerStrip;
    ColumnStrip strip(frame, first_row, std::min(first_row + kRowsPerStrip, frame.columns_z));
    fill(index, strip);
    strips[task].merged_gaps = strip.appendFree(strips[task].counts, strips[task].spans);
  });
  ExactColumns result;
  Columns& columns = result.columns;
  columns.frame = frame;
  columns.first.reserve(frame.columnCount() + 1);
  columns.first.push_back(0);
  std::size_t span_count = 0;
  for (const StripResult& strip : strips) span_count += strip.spans.size();
  columns.spans.reserve(span_count);
  for (StripResult& strip : strips) {
    for (const std::uint32_t count : strip.counts) {
      columns.first.push_back(columns.first.back() + count);
    }
    columns.spans.insert(columns.spans.end(), strip.spans.begin(), strip.spans.end());
    result.merged_gaps += strip.merged_gaps;
    strip = {};
  }
  return result;
}

}  // namespace galactic::bake
