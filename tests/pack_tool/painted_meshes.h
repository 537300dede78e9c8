#pragma once
#include <array>
#include <cstdint>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "layout/render_mesh_builder.h"
#include "support/packs/render_pack_parts.h"

namespace galactic::test {

/// What tests of the tool change in paintedMeshes().
struct Painting {
  /// One model for each.
  std::vector<std::uint32_t> parts{0};
  /// Of the walls' front edge, meters.
  float front = 1;
  std::uint32_t seed = 20231106;
  bool bc1 = false;
  bool colored = false;
  std::string paint = "paint";
  float largest_error = 0.004F;
};

/// Texels of all levels of a texture: noise, opaque where `hole` is 0, else without alpha in every
/// `hole`-th texel.
inline std::vector<std::uint8_t> noiseTexels(std::uint32_t size, std::uint32_t seed,
                                             std::uint32_t hole) {
  std::mt19937 random(seed);
  std::vector<std::uint8_t> texels(textureBytes(size, TexelFormat::kRgba8));
  for (std::size_t n = 0; n < texels.size(); ++n) {
    texels[n] = static_cast<std::uint8_t>(random() >> 24U);
    if (n % 4 == 3) texels[n] = hole != 0 && (n / 4) % hole == 0 ? 0 : 255;
  }
  return texels;
}

/// Each model: a wall (opaque texture, seen from the front), a leaf (cut-out texture, seen from
/// both sides) and a floor (plain color), each with its semantic; a meter or two in size.
inline RenderMeshStorage paintedStorage(const Painting& painting = {}) {
  constexpr std::uint32_t kSize = 16;
  std::vector<std::uint8_t> wood = noiseTexels(kSize, painting.seed, 0);
  const std::vector<std::uint8_t> leaf = noiseTexels(kSize / 2, painting.seed + 1, 3);
  if (painting.bc1) wood.resize(textureBytes(kSize, TexelFormat::kBc1));
  RenderMeshSource source;
  source.textures = {
      {"wood.png", kSize, painting.bc1 ? TexelFormat::kBc1 : TexelFormat::kRgba8, wood},
      {"leaf.png", kSize / 2, TexelFormat::kRgba8, leaf}};
  source.materials = {
      {"wood", 0xFF808080, 0, 0}, {"leaf", 0xFFFFFFFF, 1, 0.5F}, {painting.paint, 0xFF2040C0}};
  source.semantics = {"wall", "plant", "floor"};
  const auto quad = [&](const std::array<Vec3, 4>& corners, std::uint16_t number) {
    RenderSurface surface;
    surface.material = number;
    surface.semantic = number;
    surface.two_sided = number == 1;
    constexpr std::array<std::array<float, 2>, 4> kUvs{{{0, 1}, {2, 1}, {2, 0}, {0, 0}}};
    for (std::size_t n = 0; n < 4; ++n) {
      const std::uint32_t color = painting.colored && n > 1 ? 0xFF6080A0 : 0xFFFFFFFF;
      surface.vertices.push_back(
          {.position = corners[n], .u = kUvs[n][0], .v = kUvs[n][1], .color = color});
    }
    surface.corners = {0, 1, 2, 0, 2, 3};
    return surface;
  };
  for (const std::uint32_t part : painting.parts) {
    const float f = painting.front;
    source.parts.push_back(
        {.part = part,
         .surfaces = {quad({{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}}}, 0),
                      quad({{{0, 0, 0.5F}, {1, 0, 0.5F}, {1, 1, 0.5F}, {0, 1, 0.5F}}}, 1),
                      quad({{{0, 0, f}, {2, 0, f}, {2, 0, 0}, {0, 0, 0}}}, 2)},
         .source_triangles = 50,
         .largest_error = painting.largest_error});
  }
  Result<RenderMeshStorage> built = buildRenderMeshes(source);
  if (!built) throw std::runtime_error(built.error().text());
  return std::move(*built);
}

/// The same for a pack.
inline RenderMeshesField paintedMeshes(const Painting& painting = {}) {
  return fieldsOf(paintedStorage(painting));
}

}  // namespace galactic::test
