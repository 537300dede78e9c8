#include "common/memory_budget.h"

#include <gtest/gtest.h>

#include <new>

#include "galactic/bake/parallel_for.h"

namespace galactic::test::memory_budget_test {
namespace {

TEST(MemoryBudget, ComesBackWhereABakeRunsOutOfMemory) {
  bake::MemoryBudget budget(1);
  // Each wants more than there is and waits for the others: one that took its share with it would
  // keep them for ever.
  const auto bake_all = [&budget] {
    bake::parallelFor(2, 2, [&budget](std::size_t /*index*/) {
      const bake::MemoryBudget::Share share(budget, 5);
      throw std::bad_alloc();
    });
  };
  EXPECT_THROW(bake_all(), std::bad_alloc);
  const bake::MemoryBudget::Share whole(budget, 5);
}

}  // namespace
}  // namespace galactic::test::memory_budget_test
