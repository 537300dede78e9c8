#pragma once
#include <memory_resource>

namespace galactic::detail {

/// Memory in pages of 2 MB where the system provides them, for data that every step reads all over:
/// a core's TLB covers only 8 MB of small pages. Smaller requests are plain allocations. Safe to
/// use from several threads; lives until the program ends.
[[nodiscard]] std::pmr::memory_resource* hugePages() noexcept;

}  // namespace galactic::detail
