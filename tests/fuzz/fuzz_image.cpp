// Any bytes as an image that a material names: the first byte picks the alpha mode and the format
// of the result, the others are the file. The decoder has to refuse it or to give an image of the
// size that it states; what is baked of it must have the layout of a pack.
#include <bit>
#include <cstdint>
#include <span>
#include <string_view>

#include "finding.h"
#include "textures/appearance.h"
#include "textures/images/image.h"

namespace {

using galactic::test::reportFinding;

void checkAppearance(const galactic::bake::Appearance& baked) {
  if (!(baked.alpha_cutoff >= 0 && baked.alpha_cutoff <= 1)) reportFinding("a cutoff out of range");
  if (baked.size == 0) {
    if (!baked.texels.empty()) reportFinding("texels of no texture");
    return;
  }
  if (!std::has_single_bit(baked.size) || baked.size > 64) reportFinding("a size out of range");
  if (baked.texels.size() != galactic::textureBytes(baked.size, baked.format)) {
    reportFinding("texels that do not fit the size");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  namespace bake = galactic::bake;
  if (size == 0) return 0;
  const auto image = bake::decodeImage(std::as_bytes(std::span(data + 1, size - 1)));
  if (!image) {
    if (image.error().empty()) reportFinding("a refusal without a reason");
    return 0;
  }
  const std::size_t texels = std::size_t{image->width} * image->height;
  if (texels == 0 || image->rgba.size() != 4 * texels) reportFinding("an image of another size");
  // Filters of large images take the fuzzer's time and tell nothing new.
  constexpr std::size_t kManyTexels = std::size_t{1} << 16U;
  if (texels > kManyTexels) return 0;
  const bake::TransferFunction transfer;
  bake::Look look;
  look.alpha_mode = static_cast<bake::AlphaMode>(data[0] % 3);
  look.factor = {0.5F, 1, 1, 0.75F};
  bake::TextureBakeOptions options;
  options.largest = 64;
  options.format =
      (data[0] & 4U) != 0 ? galactic::TexelFormat::kBc1 : galactic::TexelFormat::kRgba8;
  checkAppearance(bake::texturedAppearance(*image, look, options, transfer));
  return 0;
}
