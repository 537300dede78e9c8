#include "drawing/contact_sheet.h"

#include <algorithm>

#include "drawing/frame_images.h"
#include "pictures/drawing.h"
#include "pictures/palette.h"

namespace galactic {

using pictures::Image;

SheetLayout sheetLayout(std::size_t count, std::size_t columns, const Image& picture,
                        std::string_view caption) {
  return {.across = static_cast<int>(std::min(columns, count)),
          .down = static_cast<int>((count + columns - 1) / columns),
          .cell_width = std::max(picture.width(), pictures::textWidth(caption)),
          .cell_height = picture.height() + kSheetGap + pictures::kTextHeight};
}

Image contactSheet(const std::vector<SheetCell>& cells, std::size_t columns) {
  const auto wider = [](const SheetCell& a, const SheetCell& b) {
    return pictures::textWidth(a.caption) < pictures::textWidth(b.caption);
  };
  const SheetLayout layout =
      sheetLayout(cells.size(), columns, cells.front().picture,
                  std::max_element(cells.begin(), cells.end(), wider)->caption);
  Image sheet(layout.width(), layout.height(), pictures::kPaper);
  for (std::size_t n = 0; n < cells.size(); ++n) {
    const Image& picture = cells[n].picture;
    const int left = kSheetGap + static_cast<int>(n % columns) * (layout.cell_width + kSheetGap);
    const int top = kSheetGap + static_cast<int>(n / columns) * (layout.cell_height + kSheetGap);
    paste(sheet, picture, left, top);
    pictures::drawText(sheet, {.x = left, .y = top + picture.height() + kSheetGap / 2},
                       cells[n].caption, pictures::kInk);
  }
  return sheet;
}

}  // namespace galactic
