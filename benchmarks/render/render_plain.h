#pragma once
#include <cstdint>
#include <span>

#include "galactic/batch_renderer.h"

namespace galactic {

/// The plain renderer that others are measured against: transforms every triangle of every model,
/// drops what faces away or reaches behind the near plane (5 cm), draws the rest pixel by pixel in
/// the order of the pools with bilinear texels of the largest level. Square images; RGBA8, depth in
/// meters.
void drawPlainly(const RenderLibrary& library, const RenderView& view, std::uint32_t edge,
                 std::span<std::uint8_t> color, std::span<float> depth);

}  // namespace galactic
