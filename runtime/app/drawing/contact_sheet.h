#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pictures/image.h"

namespace galactic {

/// A picture of a sheet and the caption below it.
struct SheetCell {
  pictures::Image picture;
  /// Phrases separated by ", ", which are wrapped to the width of the picture.
  std::string caption;
};

/// Explains the pictures of a sheet.
struct SheetGuide {
  /// Stands above the pictures of each column, `x` pixels from their left edge.
  struct Heading {
    int x = 0;
    std::string text;
  };
  /// A color and its meaning; without a color, text that continues the line.
  struct Entry {
    std::optional<pictures::Rgb> color;
    std::string text;
  };

  std::vector<Heading> headings;
  /// Lines below all pictures; each wraps if the sheet is narrow.
  std::vector<std::vector<Entry>> legend;
};

/// Pixels around and between the cells of a sheet, and between picture and caption.
inline constexpr int kSheetGap = 8;
/// The gap between captions that are wider than their pictures: larger, or they would read as one.
inline constexpr int kCaptionGap = 16;
/// Pixels from line to line of a caption.
inline constexpr int kCaptionAdvance = 18;

/// How the cells of a sheet are laid out.
struct SheetLayout {
  int across = 0;
  int down = 0;
  /// Size of a cell with its caption, pixels.
  int cell_width = 0;
  int cell_height = 0;
  /// Height of the headings above and the legend below all cells, including their gaps; 0 without
  /// them.
  int headings_height = 0;
  int legend_height = 0;
  /// The width that the widest entry of the legend needs.
  int least_width = 0;

  [[nodiscard]] int width() const;
  [[nodiscard]] int height() const {
    return headings_height + kSheetGap + down * (cell_height + kSheetGap) + legend_height;
  }
};

/// Lays out `count` cells, `columns` in each row, all as large as `picture`, or as wide as the
/// longest phrase of `captions`: those of all cells, or just the longest.
[[nodiscard]] SheetLayout sheetLayout(std::size_t count, std::size_t columns,
                                      const pictures::Image& picture,
                                      std::span<const std::string> captions,
                                      const SheetGuide& guide = {});

/// Draws the cells row by row, `columns` in each row; all are as large as the first one, or as wide
/// as their captions. Needs at least one cell.
[[nodiscard]] pictures::Image contactSheet(const std::vector<SheetCell>& cells, std::size_t columns,
                                           const SheetGuide& guide = {});

}  // namespace galactic
