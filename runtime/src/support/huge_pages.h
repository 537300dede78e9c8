#pragma once
#include <memory_resource>

namespace galactic::detail {

/// Memory in pages of 2 MB where the system gives them, for what is read all over in every step: a
/// core's table of page addresses covers 8 MB of small pages only. Smaller requests are plain
/// allocations. Safe to use from several threads; there until the program ends.
[[nodiscard]] std::pmr::memory_resource* hugePages() noexcept;

}  // namespace galactic::detail
