#pragma once
#include <cstdint>

namespace galactic::test {

/// What operator new handed out since the program began; counted_new.cpp replaces it.
[[nodiscard]] std::uint64_t allocationCount();
[[nodiscard]] std::uint64_t allocatedBytes();

/// While it lives, the allocation after `count` more throws std::bad_alloc, and no other.
class FailingAllocation {
 public:
  explicit FailingAllocation(std::uint64_t count);
  ~FailingAllocation();
  FailingAllocation(const FailingAllocation&) = delete;
  FailingAllocation& operator=(const FailingAllocation&) = delete;
  FailingAllocation(FailingAllocation&&) = delete;
  FailingAllocation& operator=(FailingAllocation&&) = delete;
};

}  // namespace galactic::test
