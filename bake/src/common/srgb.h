#pragma once
#include <cmath>

namespace galactic::bake {

/// The sRGB transfer function (IEC 61966-2-1) of a color channel: linear light, 0 to 1, as screens
/// take it.
[[nodiscard]] inline double srgbEncoded(double linear) {
  constexpr double kLinearEnd = 0.0031308;
  if (linear <= kLinearEnd) return 12.92 * linear;
  return 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

/// The way back: a channel on a screen, 0 to 1, as linear light.
[[nodiscard]] inline double srgbDecoded(double encoded) {
  constexpr double kLinearEnd = 0.04045;
  if (encoded <= kLinearEnd) return encoded / 12.92;
  return std::pow((encoded + 0.055) / 1.055, 2.4);
}

}  // namespace galactic::bake
