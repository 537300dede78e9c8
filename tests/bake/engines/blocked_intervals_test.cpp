#include "column_grid/blocked_intervals.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "galactic/bake/columns.h"

namespace galactic::bake::blocked_intervals_test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr Span kHeights{0, 3};

struct FreeSpans {
  std::vector<Span> spans;
  std::uint64_t merged_gaps = 0;
};

FreeSpans freeOf(std::vector<BlockedInterval> blocked) {
  FreeSpans result;
  result.merged_gaps = appendFreeSpans(blocked, kHeights, result.spans);
  return result;
}

TEST(BlockedIntervals, LeaveAllHeightsFreeWhenThereAreNone) {
  EXPECT_THAT(freeOf({}).spans, ElementsAre(Span{0, 3}));
}

TEST(BlockedIntervals, AreMergedInAnyOrder) {
  EXPECT_THAT(freeOf({{2, 2.5F}, {0.5F, 1.5F}, {1, 1.25F}}).spans,
              ElementsAre(Span{0, 0.5F}, Span{1.5F, 2}, Span{2.5F, 3}));
}

TEST(BlockedIntervals, AreClippedToTheHeights) {
  EXPECT_THAT(freeOf({{-5, 1}, {2, 7}}).spans, ElementsAre(Span{1, 2}));
  EXPECT_THAT(freeOf({{-5, 7}}).spans, IsEmpty());
  EXPECT_THAT(freeOf({{-5, -4}, {4, 5}}).spans, ElementsAre(Span{0, 3}));
}

TEST(BlockedIntervals, CloseGapsUpToTheToleranceAndCountThem) {
  const float narrow = 1 + 0.9F * kMergeTolerance;
  const float wide = 2 + 1.1F * kMergeTolerance;
  const FreeSpans found = freeOf({{0, 1}, {narrow, 2}, {wide, 3}});
  EXPECT_THAT(found.spans, ElementsAre(Span{2, wide}));
  EXPECT_EQ(found.merged_gaps, 1U);
}

TEST(BlockedIntervals, CountNoGapWhereTheyTouchOrOverlap) {
  EXPECT_EQ(freeOf({{0, 1}, {1, 2}, {1.5F, 2.5F}}).merged_gaps, 0U);
}

TEST(BlockedIntervals, LeaveNoSpanAsThinAsTheToleranceAtTheEndsOfTheHeights) {
  EXPECT_THAT(freeOf({{0.9F * kMergeTolerance, 3 - 0.5F * kMergeTolerance}}).spans, IsEmpty());
}

TEST(BlockedIntervals, AgreeWithTestingEachHeight) {
  constexpr unsigned kSeed = 7;
  RecordProperty("seed", static_cast<int>(kSeed));
  constexpr int kCases = 2000;
  constexpr int kHeightsPerCase = 20;
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<float> height(-0.5F, 3.5F);
  std::uniform_real_distribution<float> length(0, 0.6F);
  int free_heights = 0;
  int asked = 0;
  for (int i = 0; i < kCases; ++i) {
    std::vector<BlockedInterval> blocked(random() % 12);
    for (BlockedInterval& interval : blocked) {
      interval.lo = height(random);
      interval.hi = interval.lo + length(random);
    }
    const FreeSpans found = freeOf(blocked);
    for (std::size_t s = 1; s < found.spans.size(); ++s) {
      ASSERT_LT(found.spans[s - 1].hi, found.spans[s].lo);
    }
    std::shuffle(blocked.begin(), blocked.end(), random);
    ASSERT_EQ(freeOf(blocked).spans, found.spans);
    for (int k = 0; k < kHeightsPerCase; ++k) {
      const float y = height(random);
      // Within the tolerance of an end either answer is right.
      const auto near = [&](float end) { return std::abs(y - end) <= kMergeTolerance; };
      if (near(kHeights.lo) || near(kHeights.hi)) continue;
      if (std::any_of(blocked.begin(), blocked.end(), [&](const BlockedInterval& interval) {
            return near(interval.lo) || near(interval.hi);
          })) {
        continue;
      }
      const bool expected =
          y > kHeights.lo && y < kHeights.hi &&
          std::none_of(blocked.begin(), blocked.end(), [&](const BlockedInterval& interval) {
            return interval.lo < y && y < interval.hi;
          });
      const bool answer = std::any_of(found.spans.begin(), found.spans.end(),
                                      [&](const Span& s) { return s.lo < y && y < s.hi; });
      ASSERT_EQ(answer, expected) << "case " << i << " at " << y;
      ++asked;
      free_heights += answer ? 1 : 0;
    }
  }
  EXPECT_GT(free_heights, asked / 10);
  EXPECT_LT(free_heights, asked * 9 / 10);
}

}  // namespace
}  // namespace galactic::bake::blocked_intervals_test
