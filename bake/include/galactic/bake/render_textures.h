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
  /// RGBA, sRGB, 8 bits each, R in the lowest byte. With a texture: the texture's mean color.
  std::uint32_t color = 0xFFFFFFFF;
  /// Index into BakedMaterials::textures, or -1.
  std::int32_t texture = -1;
  /// 0: opaque; otherwise at most 1: texels with less alpha than this are not drawn.
  float alpha_cutoff = 0;
};

/// A RenderTexture of schema/render.fbs.
struct BakedTexture {
  /// The name that the source gives it: "wood.png", "*3"; never an absolute path.
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
  /// Bytes of the images that were decoded, counting each once, at their own size with 4 bytes per
  /// texel and without mip levels: what it would take to store them as they are.
  std::uint64_t source_bytes = 0;
  /// One sentence each: images that cannot be used, translucency that cannot be shown.
  std::vector<std::string> warnings;
};

/// Images that many assets use, each decoded and scaled once. Thread-safe.
class TextureLibrary {
 public:
  TextureLibrary();
  ~TextureLibrary();
  TextureLibrary(const TextureLibrary&) = delete;
  TextureLibrary& operator=(const TextureLibrary&) = delete;

  /// What is known about the images; for the texture bakers.
  struct State;
  [[nodiscard]] State& state() { return *state_; }

 private:
  std::unique_ptr<State> state_;
};

struct TextureBakeOptions {
  /// Longest edge of a texture, texels: a power of two, 1 to 4096.
  std::uint32_t largest = 512;
  /// Format of opaque textures; cut-out textures are always kRgba8.
  TexelFormat format = TexelFormat::kRgba8;

  friend bool operator==(const TextureBakeOptions&, const TextureBakeOptions&) = default;
};

/// Where to find the images that materials name.
struct TextureFiles {
  /// The images to which the names "*N" refer.
  std::span<const EmbeddedTexture> embedded{};
  /// The folder to which the names of other textures are relative.
  std::filesystem::path folder{};
};

/// Makes flat colors and small square mip-mapped textures from the materials of an asset.
///
/// PNG and JPEG are decoded, each in a process of its own, because they may be hostile. Images that
/// cannot be used (missing, broken, in another format, over 16384 texels wide or high, or over 64
/// million texels in all) leave their materials with a plain color and cause one warning each.
///
/// A texture's edge is the smallest power of two that holds the longer edge of its image, at most
/// `options.largest`. Images are filtered by area (linearly if they are enlarged), in linear light,
/// with colors weighted by alpha; each mip level is the mean of the next larger one. The base color
/// is multiplied in. Equal results are stored once, and an image of a single color becomes a flat
/// color. Cut-out textures keep the image's fraction of visible texels in all levels (Castano,
/// "Computing Alpha Mipmaps", 2010). Translucency is not drawn: a surface is drawn where its alpha
/// is one half or more.
///
/// Fails with kInvalidInput if `options.largest` is not a power of two from 1 to 4096, and with
/// kUnsupported if the texels would exceed a pack's 2 GiB. Thread-safe.
///
/// `library`: where images of other assets are reused from; null: nowhere. The result depends
/// neither on it nor on `threads`.
[[nodiscard]] Result<BakedMaterials> bakeMaterials(std::span<const SourceMaterial> materials,
                                                   const TextureFiles& files,
                                                   const TextureBakeOptions& options,
                                                   unsigned threads = 1,
                                                   TextureLibrary* library = nullptr);

/// The texture's hash as 32 hexadecimal digits: the name of its pack.
[[nodiscard]] std::string textureHash(const BakedTexture& texture);

}  // namespace galactic::bake
