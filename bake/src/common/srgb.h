#pragma once
#include <cmath>

namespace galactic::bake {

/// The sRGB transfer function (IEC 61966-2-1): encodes a channel of linear light, 0 to 1, for
/// screens.
[[nodiscard]] inline double srgbEncoded(double linear) {
  constexpr double kLinearEnd = 0.0031308;
  if (linear <= kLinearEnd) return 12.92 * linear;
  return 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

/// The inverse: a channel as encoded for screens, 0 to 1, as linear light.
[[nodiscard]] inline double srgbDecoded(double encoded) {
  constexpr double kLinearEnd = 0.04045;
  if (encoded <= kLinearEnd) return encoded / 12.92;
  return std::pow((encoded + 0.055) / 1.055, 2.4);
}

}  // namespace galactic::bake
