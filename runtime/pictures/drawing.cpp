#include "pictures/drawing.h"

#include <algorithm>

#include "pictures/font.h"

namespace galactic::pictures {

namespace {

void drawGlyph(Image& image, int x, int y, const Glyph& glyph, Rgb color) {
  for (int row = 0; row < kGlyphHeight; ++row) {
    for (int column = 0; column < kGlyphWidth; ++column) {
      const unsigned mask = 1U << static_cast<unsigned>(kGlyphWidth - 1 - column);
      if ((glyph[static_cast<std::size_t>(row)] & mask) == 0) continue;
      fillRect(image, {x + column * kTextScale, y + row * kTextScale, kTextScale, kTextScale},
               color);
    }
  }
}

}  // namespace

void fillRect(Image& image, const PixelRect& rect, Rgb color) {
  const int left = std::max(rect.x, 0);
  const int right = std::min(rect.right(), image.width());
  const int bottom = std::min(rect.bottom(), image.height());
  for (int y = std::max(rect.y, 0); y < bottom; ++y) {
    for (int x = left; x < right; ++x) image.set(x, y, color);
  }
}

void paste(Image& onto, const Image& picture, int left, int top) {
  for (int y = 0; y < picture.height(); ++y) {
    for (int x = 0; x < picture.width(); ++x) onto.set(left + x, top + y, picture.at(x, y));
  }
}

void drawFrame(Image& image, const PixelRect& rect, Rgb color) {
  fillRect(image, {rect.x - 1, rect.y - 1, rect.width + 2, 1}, color);
  fillRect(image, {rect.x - 1, rect.bottom(), rect.width + 2, 1}, color);
  fillRect(image, {rect.x - 1, rect.y, 1, rect.height}, color);
  fillRect(image, {rect.right(), rect.y, 1, rect.height}, color);
}

int textWidth(std::string_view text) {
  return std::max(0, static_cast<int>(lettering(text).size()) * kTextAdvance - kTextScale);
}

void drawText(Image& image, TextPlace place, std::string_view text, Rgb color) {
  int x = place.x;
  if (place.anchor == Anchor::kCenter) x -= textWidth(text) / 2;
  if (place.anchor == Anchor::kRight) x -= textWidth(text);
  for (const char letter : lettering(text)) {
    drawGlyph(image, x, place.y + glyphDrop(letter) * kTextScale, glyphOf(letter), color);
    x += kTextAdvance;
  }
}

}  // namespace galactic::pictures
