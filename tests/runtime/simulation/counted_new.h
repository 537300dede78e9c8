#pragma once
#include <cstdint>

namespace galactic::test {

/// What operator new handed out since the program began; counted_new.cpp replaces it.
[[nodiscard]] std::uint64_t allocationCount();
[[nodiscard]] std::uint64_t allocatedBytes();

}  // namespace galactic::test
