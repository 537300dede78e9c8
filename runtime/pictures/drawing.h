#pragma once
#include <string_view>

#include "pictures/image.h"

namespace galactic::pictures {

/// A rectangle of pixels: columns x to x + width - 1, rows y to y + height - 1.
struct PixelRect {
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;

  [[nodiscard]] int right() const { return x + width; }
  [[nodiscard]] int bottom() const { return y + height; }
};

/// Which part of a text stands at the given x.
enum class Anchor { kLeft, kCenter, kRight };

/// Where a text goes: x by `anchor`, y is its top row.
struct TextPlace {
  int x = 0;
  int y = 0;
  Anchor anchor = Anchor::kLeft;
};

/// Pixels per font pixel, and what follows from it.
inline constexpr int kTextScale = 2;
inline constexpr int kTextHeight = 7 * kTextScale;
inline constexpr int kTextAdvance = 6 * kTextScale;

/// Fills a rectangle; what lies outside the image is cut off.
void fillRect(Image& image, const PixelRect& rect, Rgb color);

/// Copies a picture into another, its top left corner at (left, top).
void paste(Image& onto, const Image& picture, int left, int top);

/// A frame one pixel wide just outside `rect`.
void drawFrame(Image& image, const PixelRect& rect, Rgb color);

/// Width of a text in pixels, as drawText() writes it.
[[nodiscard]] int textWidth(std::string_view text);

/// Draws a UTF-8 text in one line, in ASCII: see lettering().
void drawText(Image& image, TextPlace place, std::string_view text, Rgb color);

}  // namespace galactic::pictures
