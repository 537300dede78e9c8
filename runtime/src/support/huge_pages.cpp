#include "support/huge_pages.h"

#include <algorithm>
#include <cstddef>
#include <new>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace galactic::detail {
namespace {

constexpr std::size_t kHugePage = std::size_t{2} << 20U;

std::size_t alignmentFor(std::size_t bytes, std::size_t alignment) {
  return bytes < kHugePage ? alignment : std::max(alignment, kHugePage);
}

class HugePages final : public std::pmr::memory_resource {
 private:
  void* do_allocate(std::size_t bytes, std::size_t alignment) override;
  void do_deallocate(void* memory, std::size_t bytes, std::size_t alignment) override;
  [[nodiscard]] bool do_is_equal(const std::pmr::memory_resource& other) const noexcept override;
};

void* HugePages::do_allocate(std::size_t bytes, std::size_t alignment) {
  void* memory = ::operator new (bytes, std::align_val_t{alignmentFor(bytes, alignment)});
#if defined(__linux__)
  // Only advice: if the system ignores it, the memory is the same, but slower.
  if (bytes >= kHugePage) static_cast<void>(madvise(memory, bytes, MADV_HUGEPAGE));
#endif
  return memory;
}

void HugePages::do_deallocate(void* memory, std::size_t bytes, std::size_t alignment) {
  ::operator delete (memory, std::align_val_t{alignmentFor(bytes, alignment)});
}

bool HugePages::do_is_equal(const std::pmr::memory_resource& other) const noexcept {
  return this == &other;
}

}  // namespace

std::pmr::memory_resource* hugePages() noexcept {
  static HugePages pages;
  return &pages;
}

}  // namespace galactic::detail
