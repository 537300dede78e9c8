#include "textures/texture_library.h"

#include <map>
#include <mutex>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "galactic/bake/source_file.h"

namespace galactic::bake {
namespace {

/// Everything that decides what an image becomes.
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

using Baked = tl::expected<ImageAppearances, std::string>;

/// Beyond this, images are baked each time: a dataset's shared ones take less.
constexpr std::size_t kMostTexelBytes = std::size_t{1} << 30U;

std::size_t texelBytes(const Baked& baked) {
  std::size_t bytes = 0;
  if (!baked) return bytes;
  for (const Appearance& appearance : baked->appearances) bytes += appearance.texels.size();
  return bytes;
}

}  // namespace

struct TextureLibrary::State {
  std::mutex mutex;
  std::map<ImageKey, Baked> known;
  std::size_t texel_bytes = 0;

  std::optional<Baked> find(const ImageKey& key) {
    const std::lock_guard lock(mutex);
    const auto found = known.find(key);
    return found == known.end() ? std::nullopt : std::optional(found->second);
  }

  void keep(ImageKey key, const Baked& baked) {
    const std::lock_guard lock(mutex);
    if (texel_bytes + texelBytes(baked) > kMostTexelBytes) return;
    if (known.try_emplace(std::move(key), baked).second) texel_bytes += texelBytes(baked);
  }
};

TextureLibrary::TextureLibrary() : state_(std::make_unique<State>()) {}
TextureLibrary::~TextureLibrary() = default;

Baked bakeRemembered(std::span<const std::byte> file, std::span<const Look> looks,
                     const TextureBakeOptions& options, const TransferFunction& transfer) {
  if (!options.library) return bakeIsolated(file, looks, options, transfer);
  TextureLibrary::State& library = options.library->state();
  const SourceFile content = describeBytes({}, file);
  ImageKey key{content.hash_low,
               content.hash_high,
               options.largest,
               options.format,
               {looks.begin(), looks.end()}};
  if (auto known = library.find(key)) return std::move(*known);
  // Outside of the lock: two threads may bake the same image, with the same result.
  auto baked = bakeIsolated(file, looks, options, transfer);
  library.keep(std::move(key), baked);
  return baked;
}

}  // namespace galactic::bake
