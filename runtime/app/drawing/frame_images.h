#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include "galactic/batch_renderer.h"
#include "pictures/image.h"
#include "pictures/png_file.h"

namespace galactic {

/// One image of a batch, as a renderer left it: spans of width * height pixels (color: times the
/// bytes of the format), empty where it was not asked for.
struct DrawnImage {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  ColorFormat format = ColorFormat::kRgb8;
  std::span<const std::uint8_t> color;
  /// Meters; 0 where nothing is.
  std::span<const float> depth;
  std::span<const std::uint32_t> semantics;
};

/// Colors as they are.
[[nodiscard]] pictures::Image colorPicture(const DrawnImage& image);

/// Depth to look at: white at the camera, half as bright at kHalfBright meters, black where nothing
/// is.
[[nodiscard]] pictures::Image depthPicture(const DrawnImage& image);
inline constexpr float kHalfBright = 2;
/// The gray of a depth there, meters; not negative.
[[nodiscard]] pictures::Rgb depthColor(float depth);

/// The color of an id in semanticPicture; black of 0.
[[nodiscard]] pictures::Rgb semanticColor(std::uint32_t id);

/// Ids to look at: a color for each; black where nothing is.
[[nodiscard]] pictures::Image semanticPicture(const DrawnImage& image);

/// Depth in millimeters, rounded; 0 where nothing is, 65535 for that far and farther.
[[nodiscard]] pictures::DeepImage depthNumbers(const DrawnImage& image);

/// Ids; 65535 for that and higher ones.
[[nodiscard]] pictures::DeepImage semanticNumbers(const DrawnImage& image);

}  // namespace galactic
