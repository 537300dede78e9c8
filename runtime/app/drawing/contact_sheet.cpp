#include "drawing/contact_sheet.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "drawing/frame_images.h"
#include "pictures/drawing.h"
#include "pictures/palette.h"

namespace galactic {

using pictures::Image;

namespace {

using Lines = std::array<std::string_view, 2>;

int widthOf(const Lines& lines) {
  return std::max(pictures::textWidth(lines[0]), pictures::textWidth(lines[1]));
}

/// The caption in two lines that are as narrow as its blanks allow; the second one is empty where
/// it has none.
Lines brokenInTwo(std::string_view caption) {
  Lines best{caption, {}};
  for (std::size_t blank = caption.find(' '); blank != std::string_view::npos;
       blank = caption.find(' ', blank + 1)) {
    const Lines lines{caption.substr(0, blank), caption.substr(blank + 1)};
    if (widthOf(lines) < widthOf(best)) best = lines;
  }
  return best;
}

Lines linesOf(std::string_view caption, const SheetLayout& layout) {
  return layout.has_two_lines ? brokenInTwo(caption) : Lines{caption, {}};
}

}  // namespace

SheetLayout sheetLayout(std::size_t count, std::size_t columns, const Image& picture,
                        std::span<const std::string> captions) {
  SheetLayout layout{.across = static_cast<int>(std::min(columns, count)),
                     .down = static_cast<int>((count + columns - 1) / columns)};
  layout.has_two_lines = std::ranges::any_of(captions, [&](const std::string& caption) {
    return pictures::textWidth(caption) > picture.width() && !brokenInTwo(caption)[1].empty();
  });
  int text_width = 0;
  for (const std::string& caption : captions) {
    text_width = std::max(text_width, widthOf(linesOf(caption, layout)));
  }
  const bool is_wide = text_width > picture.width();
  layout.cell_width = is_wide ? text_width + kCaptionGap - kSheetGap : picture.width();
  layout.cell_height = picture.height() + kSheetGap + pictures::kTextHeight +
                       (layout.has_two_lines ? kCaptionAdvance : 0);
  return layout;
}

Image contactSheet(const std::vector<SheetCell>& cells, std::size_t columns) {
  std::vector<std::string> captions;
  captions.reserve(cells.size());
  for (const SheetCell& cell : cells) captions.push_back(cell.caption);
  const SheetLayout layout = sheetLayout(cells.size(), columns, cells.front().picture, captions);
  Image sheet(layout.width(), layout.height(), pictures::kPaper);
  for (std::size_t n = 0; n < cells.size(); ++n) {
    const Image& picture = cells[n].picture;
    const int left = kSheetGap + static_cast<int>(n % columns) * (layout.cell_width + kSheetGap);
    const int top = kSheetGap + static_cast<int>(n / columns) * (layout.cell_height + kSheetGap);
    paste(sheet, picture, left, top);
    int line_top = top + picture.height() + kSheetGap / 2;
    for (const std::string_view line : linesOf(cells[n].caption, layout)) {
      pictures::drawText(sheet, {.x = left, .y = line_top}, line, pictures::kInk);
      line_top += kCaptionAdvance;
    }
  }
  return sheet;
}

}  // namespace galactic
