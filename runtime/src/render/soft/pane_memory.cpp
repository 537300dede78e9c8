#include "render/soft/pane_memory.h"

#include "support/huge_pages.h"

namespace galactic::render {
namespace {

constexpr std::size_t kAlignment = 64;

constexpr std::size_t wholeLines(std::size_t bytes) {
  return (bytes + kAlignment - 1) / kAlignment * kAlignment;
}

constexpr std::size_t wholeTiles(std::uint32_t pixels) {
  return (pixels + kTileEdge - 1) / kTileEdge;
}

/// Hands out a block piece by piece; without a block it only counts bytes.
class Pieces {
 public:
  explicit Pieces(std::byte* block) : block_(block) {}

  template <class T>
  void take(T*& pointer, std::size_t count) {
    if (block_ != nullptr) pointer = reinterpret_cast<T*>(block_ + used_);
    used_ += wholeLines(count * sizeof(T));
  }
  [[nodiscard]] std::size_t used() const { return used_; }

 private:
  std::byte* block_;
  std::size_t used_ = 0;
};

std::size_t layOut(std::byte* block, std::size_t tiles, PaneScratch& scratch) {
  Pieces pieces(block);
  constexpr std::size_t kTilePixels = std::size_t{kTileEdge} * kTileEdge;
  pieces.take(scratch.depth, tiles * kTilePixels);
  pieces.take(scratch.ids, tiles * kTilePixels);
  // Reads go beyond the last tile, since they take squares of up to four by four tiles or rows of
  // up to sixteen.
  pieces.take(scratch.tile_depth, tiles + std::size_t{4} * kMostTiles);
  pieces.take(scratch.tile_changed, kMostTiles + 4);
  pieces.take(scratch.bucket_starts, kBuckets + 1);
  pieces.take(scratch.records, std::size_t{kMostRecords} * kRecordStride);
  pieces.take(scratch.colors, std::size_t{kMostRecords} * kRecordStride);
  return pieces.used();
}

}  // namespace

PaneMemory::PaneMemory(std::uint32_t width, std::uint32_t height) {
  const std::size_t tiles = wholeTiles(width) * wholeTiles(height);
  block_bytes_ = layOut(nullptr, tiles, scratch_);
  block_ = static_cast<std::byte*>(detail::hugePages()->allocate(block_bytes_, kAlignment));
  layOut(block_, tiles, scratch_);
}

PaneMemory::~PaneMemory() { detail::hugePages()->deallocate(block_, block_bytes_, kAlignment); }

void PaneMemory::reserve(std::size_t models, std::size_t clusters) {
  // Each size is checked separately: memory may run out between two of them and be available again
  // at the next call.
  if (models > models_.size()) models_.resize(models);
  if (clusters > seen_.size()) seen_.resize(clusters);
  if (clusters > order_.size()) order_.resize(clusters);
  scratch_.seen = seen_.data();
  scratch_.order = order_.data();
}

}  // namespace galactic::render
