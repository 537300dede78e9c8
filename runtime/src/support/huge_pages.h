#pragma once
#include <cstddef>
#include <memory_resource>

namespace galactic::detail {

/// Memory in pages of 2 MB where the system gives them, for what is read all over in every step: a
/// core's table of page addresses covers 8 MB of small pages only. Smaller requests are plain
/// allocations. Safe to use from several threads.
class HugePages final : public std::pmr::memory_resource {
 private:
  void* do_allocate(std::size_t bytes, std::size_t alignment) override;
  void do_deallocate(void* memory, std::size_t bytes, std::size_t alignment) override;
  [[nodiscard]] bool do_is_equal(const std::pmr::memory_resource& other) const noexcept override;
};

}  // namespace galactic::detail
