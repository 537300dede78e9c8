#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "galactic/bake/source_asset.h"
#include "galactic/error.h"
#include "galactic/render_meshes.h"

namespace galactic::bake {

/// A RenderMaterial of schema/render.fbs.
struct BakedMaterial {
  std::string name;
  /// RGBA, sRGB, 8 bits each, R lowest. With a texture: the texture's mean.
  std::uint32_t color = 0xFFFFFFFF;
  /// Index into BakedMaterials::textures, or -1.
  std::int32_t texture = -1;
  /// 0: opaque; otherwise what has less alpha than this is not drawn; at most 1.
  float alpha_cutoff = 0;
};

/// A RenderTexture of schema/render.fbs.
struct BakedTexture {
  /// As the source names it: "wood.png", "*3"; never an absolute path.
  std::string name;
  /// Edge of the largest level, texels: a power of two.
  std::uint32_t size = 0;
  TexelFormat format = TexelFormat::kRgba8;
  /// Where it begins in BakedMaterials::texels: a multiple of 32.
  std::uint32_t first_byte = 0;
  /// XXH3-128 of its texels.
  std::uint64_t hash_low = 0;
  std::uint64_t hash_high = 0;
};

/// Materials and textures in the layout of a pack.
struct BakedMaterials {
  /// One per input material, in the same order.
  std::vector<BakedMaterial> materials;
  /// In the order in which the materials first use them; no two are equal.
  std::vector<BakedTexture> textures;
  std::vector<std::uint8_t> texels;
  /// Whether a pack names the textures by their hashes and leaves the texels to texture packs.
  bool shared = false;
  /// Bytes of the images that were decoded, each once, at their own size with 4 bytes a texel and
  /// without mip levels: what it would take to keep them as they are.
  std::uint64_t source_bytes = 0;
  /// One sentence each: images that cannot be used, translucency that cannot be shown.
  std::vector<std::string> warnings;
};

/// Images that many assets show, each decoded and scaled once. Thread-safe.
class TextureLibrary {
 public:
  TextureLibrary();
  ~TextureLibrary();
  TextureLibrary(const TextureLibrary&) = delete;
  TextureLibrary& operator=(const TextureLibrary&) = delete;

  /// What is known of the images; for the bakers of textures.
  struct State;
  [[nodiscard]] State& state() { return *state_; }

 private:
  std::unique_ptr<State> state_;
};

struct TextureBakeOptions {
  /// Longest edge of a texture, texels: a power of two, 1 to 4096.
  std::uint32_t largest = 512;
  /// Of opaque textures; those with a cut-out shape are always kRgba8.
  TexelFormat format = TexelFormat::kRgba8;

  friend bool operator==(const TextureBakeOptions&, const TextureBakeOptions&) = default;
};

/// Where the images are that materials name.
struct TextureFiles {
  /// Those that a texture "*N" means.
  std::span<const EmbeddedTexture> embedded{};
  /// The names of other textures are relative to it.
  std::filesystem::path folder{};
};

/// Makes flat colors and small square mip-mapped textures of the materials of an asset.
///
/// PNG and JPEG are decoded, each in a process of its own, because they may be hostile.
/// Whatever cannot be used (missing, broken, another format, over 16384 texels wide or high or over
/// 64 million in all) leaves its materials with their plain color and gives one warning.
///
/// A texture's edge is the smallest power of two that holds the longer edge of its image, at most
/// `options.largest`. Filtered by area (linearly where enlarged), in linear light, colors weighted
/// with alpha; each mip level is the mean of the one above. The base color is multiplied in. Equal
/// results are stored once; an image of one color becomes a flat color. Cut-out textures keep the
/// image's share of visible texels in all levels (Castano, "Computing Alpha Mipmaps", 2010).
/// Translucency is not drawn: from half alpha upwards a surface is there.
///
/// Fails with kInvalidInput when `options.largest` is no power of two from 1 to 4096, kUnsupported
/// when the texels would exceed a pack's 2 GiB. Thread-safe.
///
/// `library`: where images of other assets are found again; null: nowhere. The result depends
/// neither on it nor on `threads`.
[[nodiscard]] Result<BakedMaterials> bakeMaterials(std::span<const SourceMaterial> materials,
                                                   const TextureFiles& files,
                                                   const TextureBakeOptions& options,
                                                   unsigned threads = 1,
                                                   TextureLibrary* library = nullptr);

/// 32 hexadecimal digits of the texture's hash: the name of its pack.
[[nodiscard]] std::string textureHash(const BakedTexture& texture);

}  // namespace galactic::bake
