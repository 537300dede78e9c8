#include "episodes/trial/memory_world.h"

#include <cstring>
#include <utility>
#include <vector>

#include "galactic/bake/packs.h"
#include "galactic/pack_header.h"
#include "support/try.h"

namespace galactic::bake {

/// A file in memory, aligned as packs require.
class MemoryWorld::FileBytes {
 public:
  FileBytes(const PackHeader& header, std::span<const std::byte> payload)
      : size_(sizeof(header) + payload.size()), blocks_((size_ + kBlock - 1) / kBlock) {
    std::memcpy(blocks_.data(), &header, sizeof(header));
    // The header fills the first block.
    static_assert(sizeof(PackHeader) == kBlock);
    if (!payload.empty()) std::memcpy(blocks_.data() + 1, payload.data(), payload.size());
  }

  [[nodiscard]] std::span<const std::byte> bytes() const {
    return {reinterpret_cast<const std::byte*>(blocks_.data()), size_};
  }

 private:
  static constexpr std::size_t kBlock = 64;
  struct alignas(kBlock) Block {
    std::byte bytes[kBlock];
  };

  std::size_t size_;
  std::vector<Block> blocks_;
};

MemoryWorld::MemoryWorld(std::shared_ptr<const FileBytes> episodes, World world)
    : episodes_(std::move(episodes)), world_(std::move(world)) {}

Result<MemoryWorld> MemoryWorld::open(std::span<const PackFile* const> packs,
                                      const SourceEpisodes& episodes) {
  ASSIGN_OR_RETURN(const auto payload, encodeEpisodePack(episodes, {}));
  auto bytes = std::make_shared<const FileBytes>(makePackHeader(PackKind::kEpisodes, payload),
                                                 std::span(payload));
  std::vector<PackFile> files;
  files.reserve(packs.size() + 1);
  for (const PackFile* pack : packs) {
    ASSIGN_OR_RETURN(auto file, PackFile::view(pack->bytes(), pack->where(), Trust::kTrusted));
    files.push_back(std::move(file));
  }
  ASSIGN_OR_RETURN(auto file, PackFile::view(bytes->bytes(), "episodes", Trust::kTrusted));
  files.push_back(std::move(file));
  ASSIGN_OR_RETURN(auto world, World::from(std::move(files)));
  return MemoryWorld(std::move(bytes), std::move(world));
}

}  // namespace galactic::bake
