#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pictures/image.h"

namespace galactic {

/// A picture of a sheet and what stands below it.
struct SheetCell {
  pictures::Image picture;
  /// Phrases with ", " between them, from line to line as the picture is wide.
  std::string caption;
};

/// What explains the pictures of a sheet.
struct SheetGuide {
  /// Above the pictures of each column, `x` pixels from their left edge.
  struct Heading {
    int x = 0;
    std::string text;
  };
  /// A color and what it means, or what follows in its line.
  struct Entry {
    std::optional<pictures::Rgb> color;
    std::string text;
  };

  std::vector<Heading> headings;
  /// Below all of them, each on a line of its own, or on more where the sheet is narrow.
  std::vector<std::vector<Entry>> legend;
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
  /// Of the headings above and the legend below all cells, with their gaps; 0 without.
  int headings_height = 0;
  int legend_height = 0;
  /// What the widest entry of the legend needs.
  int least_width = 0;

  [[nodiscard]] int width() const;
  [[nodiscard]] int height() const {
    return headings_height + kSheetGap + down * (cell_height + kSheetGap) + legend_height;
  }
};

/// Of `count` cells, `columns` in each row, all as large as `picture`, or as the longest phrase of
/// `captions` is wide: those of the cells, or the longest.
[[nodiscard]] SheetLayout sheetLayout(std::size_t count, std::size_t columns,
                                      const pictures::Image& picture,
                                      std::span<const std::string> captions,
                                      const SheetGuide& guide = {});

/// The cells, row by row, `columns` in each; all as large as the first one, or as their captions
/// are wide. There is at least one cell.
[[nodiscard]] pictures::Image contactSheet(const std::vector<SheetCell>& cells, std::size_t columns,
                                           const SheetGuide& guide = {});

}  // namespace galactic
