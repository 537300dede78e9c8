#include "pictures/palette.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace galactic::pictures {

namespace {

// Evenly spaced points of viridis; straight lines between them are within 2 % of the curve.
constexpr std::array<Rgb, 10> kViridis{{{0x44, 0x01, 0x54},
                                        {0x48, 0x28, 0x78},
                                        {0x3e, 0x49, 0x89},
                                        {0x31, 0x68, 0x8e},
                                        {0x26, 0x82, 0x8e},
                                        {0x1f, 0x9e, 0x89},
                                        {0x35, 0xb7, 0x79},
                                        {0x6e, 0xce, 0x58},
                                        {0xb5, 0xde, 0x2b},
                                        {0xfd, 0xe7, 0x25}}};

std::uint8_t mix(std::uint8_t under, std::uint8_t over, double share) {
  return static_cast<std::uint8_t>(std::lround(under + (over - under) * share));
}

}  // namespace

Rgb blend(Rgb under, Rgb over, double share) {
  return {mix(under.r, over.r, share), mix(under.g, over.g, share), mix(under.b, over.b, share)};
}

Rgb scaleColor(double share) {
  const double clamped = share > 0 ? std::min(share, 1.0) : 0.0;
  const double position = clamped * (kViridis.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(position), kViridis.size() - 2);
  return blend(kViridis[below], kViridis[below + 1], position - static_cast<double>(below));
}

}  // namespace galactic::pictures
