#pragma once
#include <array>
#include <cstdint>

namespace galactic::bake {

class ColumnStrip;

/// What the vectorized kernel needs of one edge, in the frame of the triangle's first corner.
/// Distances are signed and measured in the ground plane, positive on the triangle's side.
struct ScatterEdge {
  /// Distance from the edge's line: distance_x * X + distance_z * Z + distance_0.
  float distance_x = 0;
  float distance_z = 0;
  float distance_0 = 0;
  /// Position along the edge: along_x * X + along_z * Z + along_0.
  float along_x = 0;
  float along_z = 0;
  float along_0 = 0;
  /// Height of the edge's start, its slope, and the secant of its slope angle.
  float start_y = 0;
  float slope = 0;
  float secant = 0;
  /// The planes that cut off the cylinder at its ends bound the heights: one at start_y - cotangent
  /// * along, the other at end_rise above it.
  float cotangent = 0;
  float end_rise = 0;
  /// How far the border of the raised face is shifted inward.
  float face_shift = 0;
  /// A vertical edge adds nothing to its two corners.
  bool vertical = false;
};

/// One triangle prepared for the vectorized kernel (docs/column_grids.md derives the formulas). All
/// but `origin_*` is relative to the first corner, which keeps floats accurate.
struct ScatterTriangle {
  /// First corner relative to the grid's corner, with x as the sum of two floats, and its height.
  float origin_x_high = 0;
  float origin_x_low = 0;
  double origin_z = 0;
  float origin_y = 0;
  float corner_x[3] = {0, 0, 0};
  float corner_y[3] = {0, 0, 0};
  float corner_z[3] = {0, 0, 0};
  ScatterEdge edges[3];
  /// Unit normal with normal_y >= 0, and 1 / normal_y.
  float normal_x = 0;
  float normal_y = 0;
  float normal_z = 0;
  float inverse_normal_y = 0;
  /// A vertical face adds nothing to its edges.
  bool has_face = false;
  /// Bounding box of the corners.
  float min_x = 0;
  float max_x = 0;
  float min_y = 0;
  float max_y = 0;
  float min_z = 0;
  float max_z = 0;
};

/// A rectangle of columns that a triangle may touch.
struct ScatterBlock {
  std::uint32_t first_row = 0;
  std::uint32_t end_row = 0;
  std::uint32_t first_column = 0;
  std::uint32_t end_column = 0;
};

/// The strip that a kernel writes to, in plain pointers.
struct ScatterTarget {
  /// Current intervals of the strip's columns, readable up to ColumnStrip::kPadding beyond the end
  /// of a row; empty ones have lo > hi.
  float* lo = nullptr;
  float* hi = nullptr;
  std::uint32_t first_row = 0;
  /// Number of elements from one row to the next.
  std::uint64_t stride = 0;
  /// Centers relative to the grid's corner: x of the columns as sums of two floats, as many as a
  /// row has elements, and z of all rows.
  const float* x_high = nullptr;
  const float* x_low = nullptr;
  const double* z = nullptr;
  ColumnStrip* strip = nullptr;
};

/// ColumnStrip::spill, callable without its header.
void spillInto(ColumnStrip& strip, std::uint32_t row, std::uint32_t column, float lo, float hi);

/// Adds the blocked heights of one triangle in a block of columns to a strip.
using ScatterFunction = void (*)(const ScatterTriangle& triangle, const ScatterBlock& block,
                                 float radius, const ScatterTarget& target);

void scatterPortable(const ScatterTriangle& triangle, const ScatterBlock& block, float radius,
                     const ScatterTarget& target);
void scatterAvx2(const ScatterTriangle& triangle, const ScatterBlock& block, float radius,
                 const ScatterTarget& target);
void scatterAvx512(const ScatterTriangle& triangle, const ScatterBlock& block, float radius,
                   const ScatterTarget& target);

/// The fastest kernels on this processor for narrow blocks (up to kNarrowColumns) and for wide
/// ones. All kernels give the same bits.
struct ScatterFunctions {
  ScatterFunction narrow = scatterPortable;
  ScatterFunction wide = scatterPortable;
};
inline constexpr std::uint32_t kNarrowColumns = 8;
[[nodiscard]] ScatterFunctions fastestScatter();

/// Prepares a triangle for the vectorized kernel. `corners` are relative to the grid's corner
/// (min_x, 0, min_z); `radius` is in meters.
[[nodiscard]] ScatterTriangle prepareTriangle(const std::array<std::array<double, 3>, 3>& corners,
                                              float radius);

}  // namespace galactic::bake
