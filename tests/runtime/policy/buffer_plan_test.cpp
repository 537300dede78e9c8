// Where the values of a network lie: no two that are needed together share memory.
#include "policy/buffer_plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "policy/kernels.h"

namespace galactic::policy::buffer_plan_test {
namespace {

/// A buffer as the test knows it.
struct Used {
  BufferId id = 0;
  std::size_t size = 0;
  std::size_t first = 0;
  std::size_t last = 0;
  /// What it was made of in place, or itself.
  std::size_t like = 0;
};

TEST(BufferPlan, NeverGivesTwoBuffersOneMemoryAtOneTime) {
  std::mt19937 random(5);
  std::size_t shared = 0;
  std::size_t pairs = 0;
  std::size_t in_place = 0;
  for (int round = 0; round < 200; ++round) {
    BufferPlan plan;
    std::vector<Used> buffers;
    for (std::size_t operation = 0; operation < 30; ++operation) {
      Used used{.id = 0,
                .size = 1 + random() % 100,
                .first = operation,
                .last = operation,
                .like = buffers.size()};
      const bool is_like = !buffers.empty() && random() % 2 == 0;
      if (is_like) {
        const std::size_t source = random() % buffers.size();
        used.size = buffers[source].size;
        used.like = source;
        plan.read(buffers[source].id, operation);
        buffers[source].last = operation;
        used.id = plan.addLike(buffers[source].id, operation);
      } else {
        used.id = plan.add(used.size, operation);
      }
      if (!buffers.empty() && random() % 2 == 0) {
        Used& also = buffers[random() % buffers.size()];
        plan.read(also.id, operation);
        also.last = operation;
      }
      buffers.push_back(used);
    }
    plan.place();
    for (std::size_t a = 0; a < buffers.size(); ++a) {
      ASSERT_LE(plan.offset(buffers[a].id) + plan.stride(buffers[a].id), plan.total());
      ASSERT_GE(plan.stride(buffers[a].id), buffers[a].size);
      ASSERT_EQ(plan.stride(buffers[a].id) % kLane, 0U);
      for (std::size_t b = a + 1; b < buffers.size(); ++b) {
        const bool overlap =
            plan.offset(buffers[a].id) < plan.offset(buffers[b].id) + plan.stride(buffers[b].id) &&
            plan.offset(buffers[b].id) < plan.offset(buffers[a].id) + plan.stride(buffers[a].id);
        const bool alive_together = buffers[b].first <= buffers[a].last;
        const bool replaces = buffers[b].like == a && buffers[b].first == buffers[a].last;
        ++pairs;
        shared += overlap ? 1U : 0U;
        in_place += overlap && replaces ? 1U : 0U;
        if (overlap && alive_together) {
          ASSERT_TRUE(replaces) << a << " and " << b << " in round " << round;
        }
      }
    }
  }
  EXPECT_GT(in_place, 200U);
  EXPECT_GT(shared, pairs / 10);
  EXPECT_LT(shared, pairs * 9 / 10);
}

}  // namespace
}  // namespace galactic::policy::buffer_plan_test
