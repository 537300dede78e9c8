#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "galactic/column_grid.h"
#include "galactic/pose.h"

namespace galactic::detail {

/// Added to a lift so that rounding does not ask for the same one again, meters; the fall that
/// follows takes it back.
inline constexpr float kLiftNudge = 1e-4F;
/// A lift out of one thing may lead into another; in a scene of shelves a few times.
inline constexpr int kMostLifts = 16;

/// How far up a sphere's center that is not free has to go to be free of the static scene, meters;
/// infinity when there is no free height above it. A column may call a height free that the query,
/// which counts in quanta, does not: then it is 0.
[[nodiscard]] inline float liftOutOf(const ColumnGrid& grid, const Vec3& center) noexcept {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  // Spans of a column that are looked at: far more than a building has floors and shelves.
  constexpr std::size_t kMostSpans = 64;
  const ColumnGridLayout& layout = grid.layout();
  const float cell_x = (center.x - layout.min_x) * layout.inverse_spacing;
  const float cell_z = (center.z - layout.min_z) * layout.inverse_spacing;
  const bool inside = cell_x >= 0 && cell_x < static_cast<float>(grid.columnsX()) && cell_z >= 0 &&
                      cell_z < static_cast<float>(grid.columnsZ());
  if (!inside) return kInfinity;
  std::array<Span, kMostSpans> spans{};
  const std::size_t count =
      grid.spans(static_cast<std::uint32_t>(cell_x), static_cast<std::uint32_t>(cell_z), spans);
  for (const Span& span : std::span(spans).first(std::min(count, kMostSpans))) {
    if (span.hi > center.y) return std::max(span.lo - center.y, 0.0F);
  }
  return kInfinity;
}

/// Whether a center that sinks to `height` ends on something: a span that begins where the grid
/// does has no floor.
[[nodiscard]] inline bool hasFloor(const ColumnGrid& grid, float height) noexcept {
  const ColumnGridLayout& layout = grid.layout();
  return height > layout.heights.lo + 2 * layout.quantum;
}

}  // namespace galactic::detail
