#pragma once
#include <sys/mman.h>

#include <cstddef>
#include <new>
#include <span>

namespace galactic::bench {

/// Whether an arena asks the kernel for 2 MB pages, which spare address translations, or forbids
/// them.
enum class Pages { kHuge, kSmall };

/// One block of memory from which a layout takes all it needs, so that both layouts are measured on
/// the same kind of pages. Freed as a whole.
class Arena {
 public:
  Arena(std::size_t bytes, Pages pages) : capacity_(bytes + kHugePage) {
    block_ = ::mmap(nullptr, capacity_, PROT_READ | PROT_WRITE,
                    MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (block_ == MAP_FAILED) throw std::bad_alloc();
    // Advice only: where the kernel has no huge pages the figures say so by themselves.
    ::madvise(block_, capacity_, pages == Pages::kHuge ? MADV_HUGEPAGE : MADV_NOHUGEPAGE);
  }
  ~Arena() { ::munmap(block_, capacity_); }
  Arena(const Arena&) = delete;
  Arena& operator=(const Arena&) = delete;

  /// `count` zeroed elements, aligned to a cache line.
  template <class T>
  std::span<T> take(std::size_t count) {
    const std::size_t begin = (used_ + kCacheLine - 1) / kCacheLine * kCacheLine;
    if (begin + count * sizeof(T) > capacity_) throw std::bad_alloc();
    used_ = begin + count * sizeof(T);
    return {reinterpret_cast<T*>(static_cast<std::byte*>(block_) + begin), count};
  }

  [[nodiscard]] std::size_t used() const { return used_; }

  /// What an array of `bytes` may take of an arena.
  static constexpr std::size_t roomFor(std::size_t bytes) { return bytes + kCacheLine; }

 private:
  static constexpr std::size_t kHugePage = std::size_t{1} << 21U;
  static constexpr std::size_t kCacheLine = 64;

  std::size_t capacity_;
  void* block_ = nullptr;
  std::size_t used_ = 0;
};

}  // namespace galactic::bench
