#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "galactic/render_library.h"
#include "render/gl/handles.h"

namespace galactic::render::gl {

/// Where a texture lies, in one number: layer in bits 0 to 15, array in bits 16 to 23, the
/// logarithm of its edge in bits 24 to 31.
inline constexpr std::uint32_t kNoTexture = 0xFFFFFFFF;
[[nodiscard]] constexpr std::uint32_t textureSlot(std::size_t array, std::size_t layer,
                                                  std::uint32_t log_size) {
  return static_cast<std::uint32_t>(layer) | static_cast<std::uint32_t>(array) << 16U |
         log_size << 24U;
}

/// The driver's limits.
struct TextureLimits {
  /// Arrays that a fragment shader can read.
  std::size_t arrays = 16;
  /// Layers of an array.
  std::size_t layers = 2048;
  /// Whether the driver reads BC1 blocks; otherwise they are decoded.
  bool bc1 = true;
};

/// Textures of one size and format: the layers of one array.
struct TextureArray {
  std::uint32_t size = 0;
  TexelFormat format = TexelFormat::kRgba8;
  std::vector<const RenderTexture*> layers;
};

/// How the textures of a library are distributed over arrays.
struct TexturePlan {
  std::vector<TextureArray> arrays;
  /// For each pack and each texture in it: the textureSlot().
  std::vector<std::vector<std::uint32_t>> slots;
};

/// Fails with kUnsupported if the textures do not fit into the arrays that the driver offers.
[[nodiscard]] Result<TexturePlan> planTextures(const RenderLibrary& library,
                                               const TextureLimits& limits);

/// Makes the arrays and fills them.
[[nodiscard]] std::vector<Texture> uploadTextures(const TexturePlan& plan);

}  // namespace galactic::render::gl
