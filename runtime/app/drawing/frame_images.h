#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include "galactic/batch_renderer.h"
#include "pictures/image.h"
#include "pictures/png_file.h"

namespace galactic {

/// One image of a batch as a renderer left it: spans of width * height pixels (for color, times the
/// bytes of the format), empty if not requested.
struct DrawnImage {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  ColorFormat format = ColorFormat::kRgb8;
  std::span<const std::uint8_t> color;
  /// Meters; 0 where there is nothing.
  std::span<const float> depth;
  std::span<const std::uint32_t> semantics;
};

/// The colors, unchanged.
[[nodiscard]] pictures::Image colorPicture(const DrawnImage& image);

/// Depth for viewing: white at the camera, half as bright at kHalfBright meters, black where there
/// is nothing.
[[nodiscard]] pictures::Image depthPicture(const DrawnImage& image);
inline constexpr float kHalfBright = 2;
/// The gray of a depth in depthPicture(); meters, not negative.
[[nodiscard]] pictures::Rgb depthColor(float depth);

/// The color of an id in semanticPicture(); black for 0.
[[nodiscard]] pictures::Rgb semanticColor(std::uint32_t id);

/// Ids for viewing: one color for each; black where there is nothing.
[[nodiscard]] pictures::Image semanticPicture(const DrawnImage& image);

/// Depth in millimeters, rounded; 0 where there is nothing, 65535 at that distance and beyond.
[[nodiscard]] pictures::DeepImage depthNumbers(const DrawnImage& image);

/// Ids; 65535 for that id and higher ones.
[[nodiscard]] pictures::DeepImage semanticNumbers(const DrawnImage& image);

}  // namespace galactic
