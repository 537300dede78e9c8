#include "column_grid/cell_columns.h"

#include <algorithm>
#include <array>

#include "column_grid/assemble_columns.h"
#include "column_grid/triangle_bins.h"
#include "galactic/bake/triangle_interval.h"

namespace galactic::bake {
namespace {

std::array<Point, 3> cornersOf(const TriangleMesh& mesh, std::uint32_t index) {
  std::array<Point, 3> corners{};
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3& corner = mesh.vertices[mesh.triangles[index][i]];
    corners[i] = {static_cast<double>(corner.x), static_cast<double>(corner.y),
                  static_cast<double>(corner.z)};
  }
  return corners;
}

void scatterOverCells(const TriangleMesh& mesh, const GridFrame& frame, std::uint32_t index,
                      ColumnStrip& strip) {
  constexpr double kPad = static_cast<double>(kMergeTolerance);
  const std::array<Point, 3> corners = cornersOf(mesh, index);
  const double half = static_cast<double>(frame.spacing) / 2 + kPad;
  const double radius = static_cast<double>(frame.radius);
  const double reach = radius + half;
  const auto [min_x, max_x] = std::minmax({corners[0][0], corners[1][0], corners[2][0]});
  const auto [min_z, max_z] = std::minmax({corners[0][2], corners[1][2], corners[2][2]});
  const IndexRange rows = rowsWithin(frame, min_z - reach, max_z + reach);
  const IndexRange columns = columnsWithin(frame, min_x - reach, max_x + reach);
  const std::uint32_t end = std::min(rows.end, strip.endRow());
  for (std::uint32_t k = std::max(rows.first, strip.firstRow()); k < end; ++k) {
    for (std::uint32_t i = columns.first; i < columns.end; ++i) {
      const auto heights =
          touchingHeightsOverCell(corners, frame.centreX(i), frame.centreZ(k), half, radius);
      if (!heights) continue;
      strip.add(k, i, static_cast<float>(heights->lo - kPad),
                static_cast<float>(heights->hi + kPad));
    }
  }
}

}  // namespace

ExactColumns cellColumns(const TriangleMesh& mesh, const GridFrame& frame, unsigned jobs) {
  const double reach = static_cast<double>(frame.radius) + static_cast<double>(frame.spacing);
  const TriangleBins bins(mesh, frame, kRowsPerStrip, reach);
  return assembleColumns(frame, jobs, bins.stripCount(),
                         [&](std::uint32_t index, ColumnStrip& strip) {
                           for (const std::uint32_t triangle : bins.triangles(index)) {
                             scatterOverCells(mesh, frame, triangle, strip);
                           }
                         });
}

}  // namespace galactic::bake
