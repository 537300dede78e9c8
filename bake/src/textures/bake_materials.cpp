#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <map>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "galactic/bake/parallel_for.h"
#include "galactic/bake/render_textures.h"
#include "galactic/bake/source_asset.h"
#include "support/try.h"
#include "textures/appearance.h"
#include "textures/texture_library.h"
#include "textures/texture_source.h"

namespace galactic::bake {
namespace {

constexpr std::uint32_t kLargestTexture = 4096;
constexpr std::size_t kTextureAlignment = 32;
/// Limit for the texels in a pack.
constexpr std::uint64_t kMostTexelBytes = std::uint64_t{2} << 30U;

Result<void> checkOptions(const TextureBakeOptions& options) {
  if (std::has_single_bit(options.largest) && options.largest <= kLargestTexture) return {};
  return fail(ErrorCode::kInvalidInput, "largest texture",
              fmt::format("the texture size {} is not allowed; give a power of two from 1 to {}",
                          options.largest, kLargestTexture));
}

/// The result for one image: one appearance for each look of the materials that use it.
struct SourceResult {
  std::map<Look, Appearance> appearances;
  std::uint64_t image_bytes = 0;
  /// End of a sentence that begins with "the image"; empty if the image could be used.
  std::string fault;
};

/// Bakes an image. Returns false if another thread is baking it and `when_busy` is kSkip.
bool bakeSource(const TextureSource& source, const ImageBaker& baker, WhenBusy when_busy,
                SourceResult& result) {
  result.fault = source.fault;
  if (!result.fault.empty()) return true;
  std::vector<Look> looks;
  looks.reserve(result.appearances.size());
  for (const auto& [look, appearance] : result.appearances) looks.push_back(look);
  auto image = baker.bake(source.bytes, looks, when_busy);
  if (!image) return false;
  BakedImage& baked = *image;
  if (!baked) {
    result.fault = std::move(baked.error());
    return true;
  }
  result.image_bytes = baked->image_bytes;
  for (std::size_t n = 0; n < looks.size(); ++n) {
    result.appearances[looks[n]] = std::move(baked->appearances[n]);
  }
  return true;
}

/// Bakes all images. Those that other threads are baking come last, because scenes that are baked
/// at the same time show the same images in the same order.
void bakeSources(std::span<const TextureSource> sources, const ImageBaker& baker, unsigned threads,
                 std::span<SourceResult> results) {
  std::vector<char> done(sources.size());
  for (const WhenBusy when_busy : {WhenBusy::kSkip, WhenBusy::kWait}) {
    parallelFor(threads, sources.size(), [&](std::size_t n) {
      if (done[n] != 0) return;
      done[n] = bakeSource(sources[n], baker, when_busy, results[n]) ? 1 : 0;
    });
  }
}

/// Collects appearances and stores each texture once.
class Collector {
 public:
  explicit Collector(BakedMaterials& baked) : baked_(baked) {}

  void add(const SourceMaterial& material, const std::string& image, const Appearance& look) {
    baked_.materials.push_back({.name = material.name,
                                .color = look.color,
                                .texture = look.size == 0 ? -1 : textureOf(image, look),
                                .alpha_cutoff = look.alpha_cutoff});
    if (look.translucent <= 0) return;
    baked_.warnings.push_back(
        fmt::format("material '{}' is translucent ({:.3g} % of it); it is drawn opaque where its "
                    "alpha is at least {:.3g}, and not at all elsewhere",
                    material.name, 100 * look.translucent, look.alpha_cutoff));
  }

 private:
  std::int32_t textureOf(const std::string& name, const Appearance& look) {
    const SourceFile content = describeBytes({}, std::as_bytes(std::span(look.texels)));
    const Key key{look.size, look.format, content.hash_low, content.hash_high};
    const auto next = static_cast<std::int32_t>(baked_.textures.size());
    const auto [known, is_new] = by_content_.try_emplace(key, next);
    if (is_new) {
      const std::size_t first =
          (baked_.texels.size() + kTextureAlignment - 1) / kTextureAlignment * kTextureAlignment;
      baked_.textures.push_back({.name = name,
                                 .size = look.size,
                                 .format = look.format,
                                 .first_byte = static_cast<std::uint32_t>(first),
                                 .hash_low = content.hash_low,
                                 .hash_high = content.hash_high});
      baked_.texels.resize(first);
      baked_.texels.insert(baked_.texels.end(), look.texels.begin(), look.texels.end());
    }
    return known->second;
  }

  using Key = std::tuple<std::uint32_t, TexelFormat, std::uint64_t, std::uint64_t>;

  BakedMaterials& baked_;
  std::map<Key, std::int32_t> by_content_;
};

}  // namespace

Result<BakedMaterials> bakeMaterials(std::span<const SourceMaterial> materials,
                                     const TextureFiles& files, const TextureBakeOptions& options,
                                     unsigned threads, TextureLibrary* library) {
  RETURN_IF_ERROR(checkOptions(options));
  const TextureSources textures = openTextures(materials, files);
  std::vector<SourceResult> results(textures.sources.size());
  for (std::size_t m = 0; m < materials.size(); ++m) {
    if (const auto source = textures.of_material[m]) {
      results[*source].appearances.try_emplace(lookOf(materials[m]));
    }
  }
  bakeSources(textures.sources, ImageBaker(options, library), threads, results);

  BakedMaterials baked;
  std::uint64_t texel_bytes = 0;
  for (std::size_t n = 0; n < results.size(); ++n) {
    const SourceResult& result = results[n];
    baked.source_bytes += result.image_bytes;
    for (const auto& [look, appearance] : result.appearances) {
      texel_bytes += appearance.texels.size() + kTextureAlignment;
    }
    if (result.fault.empty() || textures.sources[n].fault_is_known) continue;
    baked.warnings.push_back(
        fmt::format("texture '{}' of material '{}' {}: its surfaces keep their plain color",
                    textures.sources[n].name, textures.sources[n].material, result.fault));
  }
  if (texel_bytes > kMostTexelBytes) {
    return fail(ErrorCode::kUnsupported, "textures",
                fmt::format("they take {:.3g} GiB, more than the 2 GiB of a pack; choose a smaller "
                            "largest size than {}, or bc1",
                            std::ldexp(static_cast<double>(texel_bytes), -30), options.largest));
  }
  baked.materials.reserve(materials.size());
  Collector collector(baked);
  for (std::size_t m = 0; m < materials.size(); ++m) {
    const Look look = lookOf(materials[m]);
    const auto source = textures.of_material[m];
    if (source && results[*source].fault.empty()) {
      collector.add(materials[m], textures.sources[*source].name,
                    results[*source].appearances.at(look));
    } else {
      collector.add(materials[m], {}, plainAppearance(look));
    }
  }
  return baked;
}

}  // namespace galactic::bake
