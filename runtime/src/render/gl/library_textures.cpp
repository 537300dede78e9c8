#include "render/gl/library_textures.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <iterator>
#include <map>

#include "layout/bc1.h"
#include "render/raster/tables.h"

namespace galactic::render::gl {
namespace {

/// Adds a texture to an array of its size and format that has room, or to a new one; returns its
/// textureSlot().
std::uint32_t place(const RenderTexture& texture, TexelFormat format, std::size_t most_layers,
                    std::vector<TextureArray>& arrays) {
  auto found = std::ranges::find_if(arrays, [&](const TextureArray& array) {
    return array.size == texture.size && array.format == format &&
           array.layers.size() < most_layers;
  });
  if (found == arrays.end()) {
    arrays.push_back({texture.size, format, {}});
    found = std::prev(arrays.end());
  }
  found->layers.push_back(&texture);
  return textureSlot(static_cast<std::size_t>(found - arrays.begin()), found->layers.size() - 1,
                     static_cast<std::uint32_t>(std::countr_zero(texture.size)));
}

TexturePlan spread(const RenderLibrary& library, std::size_t most_layers, bool bc1) {
  TexturePlan plan;
  plan.slots.reserve(library.packs().size());
  std::map<TextureKey, std::uint32_t> known;
  for (const RenderMeshes& meshes : library.packs()) {
    std::vector<std::uint32_t>& slots = plan.slots.emplace_back();
    slots.reserve(meshes.textures.size());
    for (const RenderTexture& texture : meshes.textures) {
      const auto [slot, is_new] = known.try_emplace(keyOf(texture));
      const TexelFormat format = bc1 ? texture.format : TexelFormat::kRgba8;
      if (is_new) slot->second = place(texture, format, most_layers, plan.arrays);
      slots.push_back(slot->second);
    }
  }
  return plan;
}

std::size_t levelBytes(std::uint32_t edge, TexelFormat format) {
  return textureBytes(edge, format) - textureBytes(edge / 2, format);
}

/// Uploads one level of one layer, in the format of the array.
void uploadLevel(GLuint array, const TextureArray& kind, GLint layer, GLint level,
                 std::span<const std::uint8_t> texels) {
  const auto edge = static_cast<GLsizei>(kind.size >> static_cast<unsigned>(level));
  if (kind.format == TexelFormat::kBc1) {
    glCompressedTextureSubImage3D(array, level, 0, 0, layer, edge, edge, 1,
                                  GL_COMPRESSED_RGB_S3TC_DXT1_EXT,
                                  static_cast<GLsizei>(texels.size()), texels.data());
  } else {
    glTextureSubImage3D(array, level, 0, 0, layer, edge, edge, 1, GL_RGBA, GL_UNSIGNED_BYTE,
                        texels.data());
  }
}

void uploadLayer(GLuint array, const TextureArray& kind, std::size_t layer) {
  const RenderTexture& texture = *kind.layers[layer];
  std::span<const std::uint8_t> texels = texture.texels;
  std::vector<std::uint32_t> decoded;
  if (texture.format != kind.format) {
    decodeBc1(texels, texture.size, decoded);
    texels = {reinterpret_cast<const std::uint8_t*>(decoded.data()),
              decoded.size() * sizeof(std::uint32_t)};
  }
  std::size_t begin = 0;
  for (GLint level = 0; kind.size >> static_cast<unsigned>(level) > 0; ++level) {
    const std::size_t bytes = levelBytes(kind.size >> static_cast<unsigned>(level), kind.format);
    uploadLevel(array, kind, static_cast<GLint>(layer), level, texels.subspan(begin, bytes));
    begin += bytes;
  }
}

Texture uploadArray(const TextureArray& kind) {
  GLuint name = 0;
  glCreateTextures(GL_TEXTURE_2D_ARRAY, 1, &name);
  Texture array(name);
  const GLint levels = std::countr_zero(kind.size) + 1;
  const bool bc1 = kind.format == TexelFormat::kBc1;
  // Not the sRGB formats, because the other backends filter the encoded values too.
  const auto edge = static_cast<GLsizei>(kind.size);
  glTextureStorage3D(name, levels, bc1 ? GL_COMPRESSED_RGB_S3TC_DXT1_EXT : GL_RGBA8, edge, edge,
                     static_cast<GLsizei>(kind.layers.size()));
  for (std::size_t layer = 0; layer < kind.layers.size(); ++layer) uploadLayer(name, kind, layer);
  glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_NEAREST);
  glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTextureParameteri(name, GL_TEXTURE_WRAP_S, GL_REPEAT);
  glTextureParameteri(name, GL_TEXTURE_WRAP_T, GL_REPEAT);
  return array;
}

}  // namespace

Result<TexturePlan> planTextures(const RenderLibrary& library, const TextureLimits& limits) {
  TexturePlan plan = spread(library, limits.layers, limits.bc1);
  // Once decoded, compressed textures can share the arrays of the others.
  if (plan.arrays.size() > limits.arrays) plan = spread(library, limits.layers, false);
  if (plan.arrays.size() > limits.arrays) {
    return fail(ErrorCode::kUnsupported, "render backend gl",
                fmt::format("the textures of the library need {} arrays; the driver has {} of up "
                            "to {} layers: bake textures in fewer sizes, or use the soft backend",
                            plan.arrays.size(), limits.arrays, limits.layers));
  }
  return plan;
}

std::vector<Texture> uploadTextures(const TexturePlan& plan) {
  std::vector<Texture> arrays;
  arrays.reserve(plan.arrays.size());
  for (const TextureArray& kind : plan.arrays) arrays.push_back(uploadArray(kind));
  return arrays;
}

}  // namespace galactic::render::gl
