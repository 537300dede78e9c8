#include "pack_tool/pictures/axes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pictures/palette.h"

namespace galactic::pictures {

namespace {

constexpr int kTickLength = 6;
/// Least distances between ticks: labels are wider than high.
constexpr int kHorizontalGap = 70;
constexpr int kVerticalGap = 36;

/// Of a legend, pixels: from a color to its meaning, and from there to the next color.
constexpr int kSwatchGap = 8;
constexpr int kEntryGap = 28;

int widthOf(const Legend::Entry& entry) {
  return kTextHeight + kSwatchGap + textWidth(entry.meaning) + kEntryGap;
}

}  // namespace

double AxisScale::pixelsPerUnit() const {
  return (last_pixel - first_pixel) / (last_value - first_value);
}

double AxisScale::position(double value) const {
  return first_pixel + (value - first_value) * pixelsPerUnit();
}

double roundDown(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  // A power of ten is not always exact; the margin keeps 0.2 from becoming 0.1.
  constexpr double kMargin = 1 + 1e-9;
  if (value * kMargin >= 5 * power) return 5 * power;
  return value * kMargin >= 2 * power ? 2 * power : power;
}

std::vector<Tick> axisTicks(const AxisScale& scale, int gap) {
  const double smallest = gap / std::abs(scale.pixelsPerUnit());
  // An axis without length has no scale.
  if (!std::isfinite(smallest) || smallest <= 0) return {};
  const double below = roundDown(smallest);
  // The next round value: 1 -> 2 -> 5 -> 10.
  const double step = below >= smallest ? below : roundDown(below * 2.5);
  const int decimals = std::max(0, static_cast<int>(-std::floor(std::log10(step) + 1e-9)));
  const double low = std::min(scale.first_value, scale.last_value);
  const double high = std::max(scale.first_value, scale.last_value);
  std::vector<Tick> ticks;
  // Far from zero, neighboring multiples of a tiny step are one number.
  constexpr double kFinest = 1e-12;
  if (!(step > kFinest * std::max(std::abs(low), std::abs(high)))) return ticks;
  const double first = std::ceil(low / step);
  const auto count = static_cast<int>(std::floor(high / step) - first) + 1;
  for (int i = 0; i < count; ++i) {
    const double value = first + i == 0 ? 0.0 : (first + i) * step;
    const int pixel = static_cast<int>(std::lround(scale.position(value)));
    ticks.push_back({value, pixel, fmt::format("{:.{}f}", value, decimals)});
  }
  return ticks;
}

void drawHorizontalAxis(Image& image, const PixelRect& plot, const AxisScale& scale,
                        std::string_view name) {
  for (const Tick& tick : axisTicks(scale, kHorizontalGap)) {
    fillRect(image, {tick.pixel, plot.bottom() + 1, 1, kTickLength}, kInk);
    drawText(image, {tick.pixel, plot.bottom() + kTickLength + 5, Anchor::kCenter}, tick.label,
             kInk);
  }
  const int name_y = plot.bottom() + kTickLength + 5 + kTextHeight + 8;
  drawText(image, {plot.x + plot.width / 2, name_y, Anchor::kCenter}, name, kInk);
}

void drawVerticalAxis(Image& image, const PixelRect& plot, const AxisScale& scale,
                      std::string_view name) {
  for (const Tick& tick : axisTicks(scale, kVerticalGap)) {
    fillRect(image, {plot.x - 1 - kTickLength, tick.pixel, kTickLength, 1}, kInk);
    drawText(image, {plot.x - kTickLength - 5, tick.pixel - kTextHeight / 2, Anchor::kRight},
             tick.label, kInk);
  }
  drawText(image, {plot.x - kAxisLabelWidth, plot.y - kAxisNameHeight}, name, kInk);
}

void drawScaleBar(Image& image, const BarPlace& place, double pixels_per_meter, int longest) {
  const double meters = roundDown(longest / pixels_per_meter);
  const int length = static_cast<int>(std::lround(meters * pixels_per_meter));
  fillRect(image, {place.x, place.y + kTextHeight / 2 - 1, length, 3}, kInk);
  fillRect(image, {place.x, place.y, 2, kTextHeight}, kInk);
  fillRect(image, {place.x + length - 2, place.y, 2, kTextHeight}, kInk);
  drawText(image, {place.x + length + 10, place.y}, fmt::format("{:g} m", meters), kInk);
}

int Legend::width() const {
  int width = 0;
  for (const Entry& entry : entries) width += widthOf(entry);
  return width;
}

void Legend::draw(Image& image, const TextPlace& place) const {
  int x = place.x;
  for (const Entry& entry : entries) {
    const PixelRect square{x, place.y, kTextHeight, kTextHeight};
    if (entry.mark) {
      entry.mark(image, square);
    } else {
      fillRect(image, square, entry.color);
      drawFrame(image, square, kInk);
    }
    drawText(image, {square.right() + kSwatchGap, place.y}, entry.meaning, kInk);
    x += widthOf(entry);
  }
}

void drawColorBar(Image& image, const PixelRect& bar, double top_value) {
  for (int row = 0; row < bar.height; ++row) {
    const double share = 1 - (row + 0.5) / bar.height;
    fillRect(image, {bar.x, bar.y + row, bar.width, 1}, scaleColor(share));
  }
  drawFrame(image, bar, kInk);
  const AxisScale scale{0, top_value, bar.bottom(), bar.y};
  for (const Tick& tick : axisTicks(scale, kVerticalGap)) {
    fillRect(image, {bar.right() + 1, tick.pixel, kTickLength, 1}, kInk);
    drawText(image, {bar.right() + kTickLength + 6, tick.pixel - kTextHeight / 2}, tick.label,
             kInk);
  }
}

}  // namespace galactic::pictures
