#pragma once
#include <functional>
#include <optional>
#include <vector>

#include "galactic/column_grid.h"
#include "pack_tool/pictures/pictures.h"
#include "pictures/drawing.h"
#include "pictures/image.h"

namespace galactic::pictures {

/// The value of a column without a span.
inline constexpr float kBlockedValue = -1;

/// A grid in a picture.
struct PlanPanel {
  const ColumnGrid* grid = nullptr;
  /// As of planValues.
  std::vector<float> values;
  PixelRect plot;
};

/// One for each column of `grid`, row by row along Z; kBlockedValue where there is no span.
[[nodiscard]] std::vector<float> planValues(const ColumnGrid& grid, PlanValue value);

/// What is free over the ground of one storey, in the same order: of each column the lowest span in
/// the scene, or with a `floor`, the storey's height, meters, the one that begins nearest to it;
/// NaN where there is none.
[[nodiscard]] std::vector<Span> storeySpans(const ColumnGrid& grid, std::optional<float> floor);

/// Paints the columns of a grid over its plot. A pixel that shows several columns has the least of
/// their values, and so is blocked where one of them is.
void paintColumns(Image& image, const PlanPanel& panel, const std::function<Rgb(float)>& color_of);

}  // namespace galactic::pictures
