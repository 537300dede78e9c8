#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <tl/expected.hpp>

#include "galactic/bake/render_textures.h"
#include "textures/isolated_bake.h"

namespace galactic::bake {

using BakedImage = tl::expected<ImageAppearances, std::string>;

/// What to do with an image that another thread is baking.
enum class WhenBusy { kSkip, kWait };

/// Bakes the images of one asset. Thread-safe.
class ImageBaker {
 public:
  /// `library`: images shared with other assets, or null. It and `options` must outlive this.
  ImageBaker(const TextureBakeOptions& options, TextureLibrary* library)
      : options_(options), library_(library) {}

  /// Like bakeIsolated, but only once for all bakers that share the library. None if another thread
  /// is baking the image and `when_busy` is kSkip.
  [[nodiscard]] std::optional<BakedImage> bake(std::span<const std::byte> file,
                                               std::span<const Look> looks,
                                               WhenBusy when_busy) const;

 private:
  const TextureBakeOptions& options_;
  TextureLibrary* library_;
  TransferFunction transfer_;
};

}  // namespace galactic::bake
