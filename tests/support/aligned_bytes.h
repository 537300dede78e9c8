#pragma once
#include <algorithm>
#include <cstddef>
#include <memory>
#include <new>
#include <span>

namespace galactic::test {

/// Bytes in a block of exactly their size, aligned as a mapped file's cache lines are: a read
/// beyond the last byte leaves the block, where a sanitizer sees it.
class AlignedBytes {
 public:
  static constexpr std::align_val_t kAlignment{64};

  AlignedBytes() : AlignedBytes(std::span<const std::byte>{}) {}

  explicit AlignedBytes(std::span<const std::byte> bytes)
      : size_(bytes.size()),
        block_(static_cast<std::byte*>(::operator new(bytes.size(), kAlignment))) {
    std::copy(bytes.begin(), bytes.end(), block_.get());
  }

  [[nodiscard]] std::span<std::byte> bytes() { return {block_.get(), size_}; }
  [[nodiscard]] std::span<const std::byte> bytes() const { return {block_.get(), size_}; }
  [[nodiscard]] std::size_t size() const { return size_; }

 private:
  struct Free {
    void operator()(std::byte* block) const { ::operator delete(block, kAlignment); }
  };

  std::size_t size_ = 0;
  std::unique_ptr<std::byte, Free> block_;
};

}  // namespace galactic::test
