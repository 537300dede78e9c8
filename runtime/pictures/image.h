#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace galactic::pictures {

/// A color, 8 bits per channel, sRGB.
struct Rgb {
  std::uint8_t r = 0;
  std::uint8_t g = 0;
  std::uint8_t b = 0;

  friend bool operator==(const Rgb&, const Rgb&) = default;
};

/// Pixels row by row from the top left corner.
class Image {
 public:
  Image(int width, int height, Rgb color)
      : width_(width),
        height_(height),
        pixels_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), color) {}

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  /// The pixel in column x of row y, which must be inside the image.
  [[nodiscard]] Rgb at(int x, int y) const { return pixels_[index(x, y)]; }
  /// Sets a pixel; outside the image it does nothing.
  void set(int x, int y, Rgb color) {
    if (x >= 0 && x < width_ && y >= 0 && y < height_) pixels_[index(x, y)] = color;
  }
  [[nodiscard]] const std::vector<Rgb>& pixels() const { return pixels_; }

 private:
  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(x);
  }

  int width_;
  int height_;
  std::vector<Rgb> pixels_;
};

}  // namespace galactic::pictures
