#pragma once
#include <cstddef>
#include <span>
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
/// More of them between captions that are wider than their pictures: else they read as one.
inline constexpr int kCaptionGap = 16;
/// And from line to line of a caption.
inline constexpr int kCaptionAdvance = 18;

/// How cells lie on a sheet.
struct SheetLayout {
  int across = 0;
  int down = 0;
  /// Of a cell, its caption included, pixels.
  int cell_width = 0;
  int cell_height = 0;
  /// Whether captions stand in two lines where they have a blank.
  bool has_two_lines = false;

  [[nodiscard]] int width() const { return kSheetGap + across * (cell_width + kSheetGap); }
  [[nodiscard]] int height() const { return kSheetGap + down * (cell_height + kSheetGap); }
};

/// Of `count` cells, `columns` in each row, all as large as `picture`, or as `captions` are wide:
/// those of the cells, or the longest. Where one is wider than the picture, all are broken in two.
[[nodiscard]] SheetLayout sheetLayout(std::size_t count, std::size_t columns,
                                      const pictures::Image& picture,
                                      std::span<const std::string> captions);

/// The cells, row by row, `columns` in each; all as large as the first one, or as their captions
/// are wide. There is at least one cell.
[[nodiscard]] pictures::Image contactSheet(const std::vector<SheetCell>& cells,
                                           std::size_t columns);

}  // namespace galactic
