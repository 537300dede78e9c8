#include "textures/texture_library.h"

#include <condition_variable>
#include <map>
#include <mutex>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "galactic/bake/read_files.h"

namespace galactic::bake {
namespace {

/// Everything that determines the result of baking an image.
struct ImageKey {
  std::uint64_t hash_low = 0;
  std::uint64_t hash_high = 0;
  std::uint32_t largest = 0;
  TexelFormat format = TexelFormat::kRgba8;
  std::vector<Look> looks;

  [[nodiscard]] bool operator<(const ImageKey& other) const {
    return std::tie(hash_low, hash_high, largest, format, looks) <
           std::tie(other.hash_low, other.hash_high, other.largest, other.format, other.looks);
  }
};

/// Beyond this limit, images are not kept and are baked each time. The shared images of a dataset
/// take less.
constexpr std::size_t kMostTexelBytes = std::size_t{1} << 30U;

std::size_t texelBytes(const BakedImage& baked) {
  std::size_t bytes = 0;
  if (!baked) return bytes;
  for (const Appearance& appearance : baked->appearances) bytes += appearance.texels.size();
  return bytes;
}

}  // namespace

struct TextureLibrary::State {
  std::mutex mutex;
  std::condition_variable was_released;
  /// The image is none while a thread is baking it.
  std::map<ImageKey, std::optional<BakedImage>> images;
  std::size_t texel_bytes = 0;

  /// Returns true if the caller must bake the image and then release it. Otherwise sets `known` to
  /// the image, or to none if another thread is baking it and `when_busy` is kSkip.
  bool claim(const ImageKey& key, WhenBusy when_busy, std::optional<BakedImage>& known) {
    std::unique_lock lock(mutex);
    while (!images.try_emplace(key).second) {
      known = images.at(key);
      if (known || when_busy == WhenBusy::kSkip) return false;
      // Afterwards, the image may not have been kept or made; then it is this thread's turn.
      was_released.wait(lock);
    }
    return true;
  }

  /// Ends a claim. If `baked` is null, the next thread that wants the image bakes it.
  void release(const ImageKey& key, const BakedImage* baked) {
    const std::lock_guard lock(mutex);
    if (baked != nullptr && texel_bytes + texelBytes(*baked) <= kMostTexelBytes) {
      images.at(key) = *baked;
      texel_bytes += texelBytes(*baked);
    } else {
      images.erase(key);
    }
    was_released.notify_all();
  }
};

TextureLibrary::TextureLibrary() : state_(std::make_unique<State>()) {}
TextureLibrary::~TextureLibrary() = default;

std::optional<BakedImage> ImageBaker::bake(std::span<const std::byte> file,
                                           std::span<const Look> looks, WhenBusy when_busy) const {
  if (library_ == nullptr) return bakeIsolated(file, looks, options_, transfer_);
  TextureLibrary::State& library = library_->state();
  const SourceFile content = describeBytes({}, file);
  const ImageKey key{content.hash_low,
                     content.hash_high,
                     options_.largest,
                     options_.format,
                     {looks.begin(), looks.end()}};
  std::optional<BakedImage> baked;
  if (!library.claim(key, when_busy, baked)) return baked;
  try {
    baked = bakeIsolated(file, looks, options_, transfer_);
  } catch (...) {
    library.release(key, nullptr);
    throw;
  }
  library.release(key, &*baked);
  return baked;
}

}  // namespace galactic::bake
