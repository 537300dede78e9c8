#include "drawing/contact_sheet.h"

#include <algorithm>
#include <string_view>

#include "drawing/frame_images.h"
#include "pictures/drawing.h"
#include "pictures/palette.h"

namespace galactic {

using pictures::Image;
using pictures::kTextHeight;
using pictures::textWidth;

namespace {

constexpr std::string_view kBetweenPhrases = ", ";
/// Size of the colors in a legend, and gaps after a color and after an entry.
constexpr int kSwatch = kTextHeight;
constexpr int kSwatchGap = 6;
constexpr int kEntryGap = 24;

/// The phrases of a caption; each but the last keeps its comma.
std::vector<std::string_view> phrasesOf(std::string_view caption) {
  std::vector<std::string_view> phrases;
  while (!caption.empty()) {
    const std::size_t comma = caption.find(kBetweenPhrases);
    const bool is_last = comma == std::string_view::npos;
    phrases.push_back(is_last ? caption : caption.substr(0, comma + 1));
    caption.remove_prefix(is_last ? caption.size() : comma + kBetweenPhrases.size());
  }
  return phrases;
}

/// The lines of a caption: each has as many phrases as fit into `width` pixels, but at least one.
std::vector<std::string> linesOf(std::string_view caption, int width) {
  std::vector<std::string> lines;
  for (const std::string_view phrase : phrasesOf(caption)) {
    const std::string longer = lines.empty() ? "" : lines.back() + ' ' + std::string(phrase);
    if (!lines.empty() && textWidth(longer) <= width) {
      lines.back() = longer;
    } else {
      lines.emplace_back(phrase);
    }
  }
  return lines;
}

int widthOf(const SheetGuide::Entry& entry) {
  return (entry.color ? kSwatch + kSwatchGap : 0) + textWidth(entry.text);
}

/// The place of an entry in the legend.
struct PlacedEntry {
  const SheetGuide::Entry* entry = nullptr;
  int x = 0;
  int line = 0;
};

/// Places the entries of a legend from left to right and line by line, within `width` pixels.
std::vector<PlacedEntry> placesOf(const SheetGuide& guide, int width) {
  std::vector<PlacedEntry> places;
  int line = 0;
  for (const auto& entries : guide.legend) {
    int x = 0;
    for (const SheetGuide::Entry& entry : entries) {
      if (x > 0 && x + widthOf(entry) > width) {
        x = 0;
        ++line;
      }
      places.push_back({&entry, x, line});
      x += widthOf(entry) + kEntryGap;
    }
    ++line;
  }
  return places;
}

void drawLegend(Image& sheet, const SheetGuide& guide, int top) {
  for (const auto& [entry, x, line] : placesOf(guide, sheet.width() - 2 * kSheetGap)) {
    const int y = top + line * kCaptionAdvance;
    int left = kSheetGap + x;
    if (entry->color) {
      const pictures::PixelRect swatch{left + 1, y + 1, kSwatch - 2, kSwatch - 2};
      pictures::fillRect(sheet, swatch, *entry->color);
      pictures::drawFrame(sheet, swatch, pictures::kFaintInk);
      left += kSwatch + kSwatchGap;
    }
    pictures::drawText(sheet, {.x = left, .y = y}, entry->text, pictures::kInk);
  }
}

}  // namespace

int SheetLayout::width() const {
  return std::max(kSheetGap + across * (cell_width + kSheetGap), least_width);
}

SheetLayout sheetLayout(std::size_t count, std::size_t columns, const Image& picture,
                        std::span<const std::string> captions, const SheetGuide& guide) {
  SheetLayout layout{.across = static_cast<int>(std::min(columns, count)),
                     .down = static_cast<int>((count + columns - 1) / columns)};
  int text_width = 0;
  for (const std::string& caption : captions) {
    for (const std::string_view phrase : phrasesOf(caption)) {
      text_width = std::max(text_width, textWidth(phrase));
    }
  }
  const bool is_wide = text_width > picture.width();
  std::size_t lines = 1;
  for (const std::string& caption : captions) {
    lines = std::max(lines, linesOf(caption, std::max(text_width, picture.width())).size());
  }
  layout.cell_width = is_wide ? text_width + kCaptionGap - kSheetGap : picture.width();
  layout.cell_height =
      picture.height() + kSheetGap + kTextHeight + static_cast<int>(lines - 1) * kCaptionAdvance;
  if (!guide.headings.empty()) layout.headings_height = kSheetGap + kTextHeight;
  for (const auto& entries : guide.legend) {
    for (const SheetGuide::Entry& entry : entries) {
      layout.least_width = std::max(layout.least_width, widthOf(entry) + 2 * kSheetGap);
    }
  }
  const auto places = placesOf(guide, layout.width() - 2 * kSheetGap);
  if (!places.empty()) {
    layout.legend_height = kSheetGap + (places.back().line + 1) * kCaptionAdvance;
  }
  return layout;
}

Image contactSheet(const std::vector<SheetCell>& cells, std::size_t columns,
                   const SheetGuide& guide) {
  std::vector<std::string> captions;
  captions.reserve(cells.size());
  for (const SheetCell& cell : cells) captions.push_back(cell.caption);
  const SheetLayout layout =
      sheetLayout(cells.size(), columns, cells.front().picture, captions, guide);
  Image sheet(layout.width(), layout.height(), pictures::kPaper);
  const auto left_of = [&layout](std::size_t column) {
    return kSheetGap + static_cast<int>(column) * (layout.cell_width + kSheetGap);
  };
  for (std::size_t column = 0; column < std::min(columns, cells.size()); ++column) {
    for (const SheetGuide::Heading& heading : guide.headings) {
      pictures::drawText(sheet, {.x = left_of(column) + heading.x, .y = kSheetGap}, heading.text,
                         pictures::kInk);
    }
  }
  for (std::size_t n = 0; n < cells.size(); ++n) {
    const Image& picture = cells[n].picture;
    const int left = left_of(n % columns);
    const int top = layout.headings_height + kSheetGap +
                    static_cast<int>(n / columns) * (layout.cell_height + kSheetGap);
    paste(sheet, picture, left, top);
    int line_top = top + picture.height() + kSheetGap / 2;
    const int room = std::max(picture.width(), layout.cell_width - kCaptionGap + kSheetGap);
    for (const std::string& line : linesOf(cells[n].caption, room)) {
      pictures::drawText(sheet, {.x = left, .y = line_top}, line, pictures::kInk);
      line_top += kCaptionAdvance;
    }
  }
  drawLegend(sheet, guide, layout.height() - layout.legend_height);
  return sheet;
}

}  // namespace galactic
