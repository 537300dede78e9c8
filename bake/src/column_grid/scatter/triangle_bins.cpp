#include "column_grid/scatter/triangle_bins.h"

#include <algorithm>
#include <cmath>

namespace galactic::bake {
namespace {

/// In cells. The extra width is cheap, because columns out of reach are rejected one by one later.
constexpr double kIndexMargin = 1e-3;

}  // namespace

IndexRange centersWithin(double lo, double hi, double spacing, std::uint32_t count) {
  const double limit = static_cast<double>(count);
  const double inverse = 1 / spacing;
  // The values are not negative, so truncation is the floor without a library call.
  const double first = std::max(lo * inverse + (0.5 - kIndexMargin), 0.0);
  const double end = std::min(hi * inverse + (0.5 + kIndexMargin), limit);
  if (!(first < end)) return {};
  return {static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(end)};
}

IndexRange rowsWithin(const GridFrame& frame, double lo, double hi) {
  const double min = static_cast<double>(frame.min_z);
  return centersWithin(lo - min, hi - min, static_cast<double>(frame.spacing), frame.columns_z);
}

IndexRange columnsWithin(const GridFrame& frame, double lo, double hi) {
  const double min = static_cast<double>(frame.min_x);
  return centersWithin(lo - min, hi - min, static_cast<double>(frame.spacing), frame.columns_x);
}

TriangleBins::TriangleBins(const TriangleMesh& mesh, const GridFrame& frame,
                           std::uint32_t rows_per_strip, double reach) {
  const std::uint32_t strips = (frame.columns_z + rows_per_strip - 1) / rows_per_strip;
  start_.assign(std::size_t{strips} + 1, 0);
  const auto strips_of = [&](const Triangle& triangle) -> IndexRange {
    const auto [lo, hi] = std::minmax(
        {mesh.vertices[triangle[0]].z, mesh.vertices[triangle[1]].z, mesh.vertices[triangle[2]].z});
    const IndexRange rows =
        rowsWithin(frame, static_cast<double>(lo) - reach, static_cast<double>(hi) + reach);
    if (rows.first >= rows.end) return {};
    return {rows.first / rows_per_strip, (rows.end - 1) / rows_per_strip + 1};
  };
  for (const Triangle& triangle : mesh.triangles) {
    const IndexRange range = strips_of(triangle);
    for (std::uint32_t strip = range.first; strip < range.end; ++strip) ++start_[strip + 1];
  }
  for (std::uint32_t strip = 0; strip < strips; ++strip) start_[strip + 1] += start_[strip];
  triangles_.resize(start_[strips]);
  std::vector<std::size_t> next(start_.begin(), start_.end() - 1);
  for (std::uint32_t index = 0; index < mesh.triangles.size(); ++index) {
    const IndexRange range = strips_of(mesh.triangles[index]);
    for (std::uint32_t strip = range.first; strip < range.end; ++strip) {
      triangles_[next[strip]++] = index;
    }
  }
}

}  // namespace galactic::bake
