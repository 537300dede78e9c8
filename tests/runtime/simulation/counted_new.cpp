#include "counted_new.h"

#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <new>

namespace {

// NOLINTBEGIN(cppcoreguidelines-avoid-non-const-global-variables): operator new has no other place.
std::atomic<std::uint64_t> allocations{0};
std::atomic<std::uint64_t> allocated_bytes{0};
/// Number of the allocation that fails.
std::atomic<std::uint64_t> failing{~std::uint64_t{0}};
// NOLINTEND(cppcoreguidelines-avoid-non-const-global-variables)

void* counted(std::size_t bytes, std::size_t alignment) {
  if (allocations.fetch_add(1) == failing.load()) throw std::bad_alloc();
  allocated_bytes.fetch_add(bytes);
  const std::size_t rounded = (bytes + alignment - 1) / alignment * alignment;
  void* block = std::aligned_alloc(alignment, rounded == 0 ? alignment : rounded);
  if (block == nullptr) throw std::bad_alloc();
  return block;
}

}  // namespace

void* operator new(std::size_t bytes) { return counted(bytes, alignof(std::max_align_t)); }
void* operator new(std::size_t bytes, std::align_val_t alignment) {
  return counted(bytes, static_cast<std::size_t>(alignment));
}
void operator delete(void* block) noexcept { std::free(block); }
void operator delete(void* block, std::size_t) noexcept { std::free(block); }
void operator delete(void* block, std::align_val_t) noexcept { std::free(block); }
void operator delete(void* block, std::size_t, std::align_val_t) noexcept { std::free(block); }

namespace galactic::test {

std::uint64_t allocationCount() { return allocations.load(); }
std::uint64_t allocatedBytes() { return allocated_bytes.load(); }

FailingAllocation::FailingAllocation(std::uint64_t count) { failing = allocations.load() + count; }
FailingAllocation::~FailingAllocation() { failing = ~std::uint64_t{0}; }

}  // namespace galactic::test
