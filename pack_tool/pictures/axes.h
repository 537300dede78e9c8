#pragma once
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "pictures/drawing.h"

namespace galactic::pictures {

/// A straight scale from values to pixels along one direction of the image.
struct AxisScale {
  double first_value = 0;
  double last_value = 1;
  int first_pixel = 0;
  int last_pixel = 1;

  /// The pixel position of a value, not rounded.
  [[nodiscard]] double position(double value) const;
  [[nodiscard]] double pixelsPerUnit() const;
};

/// A labeled mark of an axis.
struct Tick {
  double value = 0;
  int pixel = 0;
  std::string label;
};

/// The largest of 1, 2 and 5 times a power of ten that is no larger than `value`; value > 0.
[[nodiscard]] double roundDown(double value);

/// Marks at round values, at least `gap` pixels apart.
[[nodiscard]] std::vector<Tick> axisTicks(const AxisScale& scale, int gap);

/// Ticks and labels below `plot`, and the axis's name below them.
void drawHorizontalAxis(Image& image, const PixelRect& plot, const AxisScale& scale,
                        std::string_view name);

/// Ticks and labels left of `plot`, and the axis's name above the labels.
void drawVerticalAxis(Image& image, const PixelRect& plot, const AxisScale& scale,
                      std::string_view name);

/// Where a bar begins: the top of its left end.
struct BarPlace {
  int x = 0;
  int y = 0;
};

/// The length in pixels that a scale bar does not exceed when nothing else is wanted.
inline constexpr int kScaleBarPixels = 220;

/// A bar of the longest round length in meters that is no longer than `longest` pixels, and its
/// label on its right.
void drawScaleBar(Image& image, const BarPlace& place, double pixels_per_meter,
                  int longest = kScaleBarPixels);

/// What the colors and marks of a picture mean, in one line.
struct Legend {
  struct Entry {
    std::string meaning;
    Rgb color;
    /// Draws what stands in that square instead of the color; none for the color.
    std::function<void(Image& image, const PixelRect& square)> mark = {};
  };
  std::vector<Entry> entries;

  /// Pixels, the gap after each entry included.
  [[nodiscard]] int width() const;
  /// The first entry at `place`.
  void draw(Image& image, const TextPlace& place) const;
};

/// A vertical color bar with ticks on its right side. `bar` is the bar alone.
void drawColorBar(Image& image, const PixelRect& bar, double top_value);

// Room around a plot that the functions above draw in, pixels.
inline constexpr int kAxisLabelWidth = 5 * kTextAdvance + 12;
inline constexpr int kAxisBottomHeight = 2 * kTextHeight + 24;
inline constexpr int kAxisNameHeight = kTextHeight + 10;

}  // namespace galactic::pictures
