#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "pictures/image.h"

namespace galactic {

/// A picture of a sheet and what stands below it.
struct SheetCell {
  pictures::Image picture;
  std::string caption;
};

/// Pixels around and between the cells of a sheet, and between picture and caption.
inline constexpr int kSheetGap = 8;

/// The cells, row by row, `columns` in each; all as large as the first one, or as its caption is
/// wide. There is at least one cell.
[[nodiscard]] pictures::Image contactSheet(const std::vector<SheetCell>& cells,
                                           std::size_t columns);

}  // namespace galactic
