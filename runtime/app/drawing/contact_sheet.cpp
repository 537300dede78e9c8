#include "drawing/contact_sheet.h"

#include <algorithm>

#include "drawing/frame_images.h"
#include "pictures/drawing.h"
#include "pictures/palette.h"

namespace galactic {

using pictures::Image;

Image contactSheet(const std::vector<SheetCell>& cells, std::size_t columns) {
  int width = cells.front().picture.width();
  for (const SheetCell& cell : cells) width = std::max(width, pictures::textWidth(cell.caption));
  const int picture_height = cells.front().picture.height();
  const int height = picture_height + kSheetGap + pictures::kTextHeight;
  const auto across = static_cast<int>(std::min(columns, cells.size()));
  const auto down = static_cast<int>((cells.size() + columns - 1) / columns);
  Image sheet(kSheetGap + across * (width + kSheetGap), kSheetGap + down * (height + kSheetGap),
              pictures::kPaper);
  for (std::size_t n = 0; n < cells.size(); ++n) {
    const int left = kSheetGap + static_cast<int>(n % columns) * (width + kSheetGap);
    const int top = kSheetGap + static_cast<int>(n / columns) * (height + kSheetGap);
    paste(sheet, cells[n].picture, left, top);
    pictures::drawText(sheet, {.x = left, .y = top + picture_height + kSheetGap / 2},
                       cells[n].caption, pictures::kInk);
  }
  return sheet;
}

}  // namespace galactic
