// What a strip keeps of the intervals that are added to it, against all of them sorted at the end.
#include "column_grid/column_strip.h"

#include <gtest/gtest.h>

#include <array>
#include <random>
#include <vector>

#include "column_grid/blocked_intervals.h"

namespace galactic::bake::column_strip_test {
namespace {

constexpr std::uint32_t kSeed = 20261122;
constexpr std::uint32_t kColumns = 8;

GridFrame frameOfHeights(Span heights) {
  return {.radius = 0.015F,
          .spacing = 0.03F,
          .heights = heights,
          .columns_x = kColumns,
          .columns_z = 1};
}

/// The free spans of all columns of one row.
struct Found {
  std::vector<std::uint32_t> counts;
  std::vector<Span> spans;
  std::uint64_t merged_gaps = 0;
};

Found freeSpans(const ColumnStrip& strip) {
  Found found;
  found.merged_gaps = strip.appendFree(found.counts, found.spans);
  return found;
}

Found sortedAtTheEnd(std::array<std::vector<BlockedInterval>, kColumns> blocked, Span heights) {
  Found found;
  for (std::vector<BlockedInterval>& column : blocked) {
    const std::size_t before = found.spans.size();
    found.merged_gaps += appendFreeSpans(column, heights, found.spans);
    found.counts.push_back(static_cast<std::uint32_t>(found.spans.size() - before));
  }
  return found;
}

TEST(ColumnStrip, KeepsTheUnionOfFewAndOfManyIntervals) {
  std::mt19937 random(kSeed);
  constexpr Span kHeights{-10, 10};
  constexpr int kRounds = 60;
  int few = 0;
  int many = 0;
  for (int round = 0; round < kRounds; ++round) {
    ColumnStrip strip(frameOfHeights(kHeights), 0, 1);
    std::array<std::vector<BlockedInterval>, kColumns> blocked;
    // From intervals that leave hundreds of gaps to such that overlap nearly all.
    const float longest = std::array{0.004F, 0.05F, 1.0F}[static_cast<std::size_t>(round) % 3];
    std::uniform_real_distribution<float> place(-10.5F, 10.5F);
    std::uniform_real_distribution<float> length(0, longest);
    for (std::uint32_t n = 0; n < 4000; ++n) {
      const std::uint32_t column = random() % kColumns;
      // The last columns get a handful.
      if (column > 4 && n > 100) continue;
      const float lo = place(random);
      const float hi = lo + length(random);
      strip.add(0, column, lo, hi);
      blocked[column].push_back({lo, hi});
    }
    const Found found = freeSpans(strip);
    const Found wanted = sortedAtTheEnd(blocked, kHeights);
    ASSERT_EQ(found.counts, wanted.counts) << "seed " << kSeed << ", round " << round;
    ASSERT_EQ(found.merged_gaps, wanted.merged_gaps) << "seed " << kSeed << ", round " << round;
    for (std::size_t n = 0; n < found.spans.size(); ++n) {
      ASSERT_EQ(found.spans[n].lo, wanted.spans[n].lo) << "seed " << kSeed << ", round " << round;
      ASSERT_EQ(found.spans[n].hi, wanted.spans[n].hi) << "seed " << kSeed << ", round " << round;
    }
    for (const std::uint32_t count : found.counts) ++(count > 64 ? many : few);
  }
  const double share = static_cast<double>(many) / static_cast<double>(few + many);
  EXPECT_GT(share, 0.1);
  EXPECT_LT(share, 0.9);
}

// One by one through a list this would be twenty thousand million comparisons.
TEST(ColumnStrip, TakesManyThousandDisjointIntervals) {
  constexpr std::uint32_t kCount = 200'000;
  constexpr Span kHeights{-1, static_cast<float>(kCount)};
  ColumnStrip strip(frameOfHeights(kHeights), 0, 1);
  for (std::uint32_t n = 0; n < kCount; ++n) {
    // A step that has no divisor in common with the count visits each height once.
    const auto lo = static_cast<float>(std::uint64_t{n} * 77'777 % kCount);
    strip.add(0, 0, lo, lo + 0.5F);
  }
  const Found found = freeSpans(strip);
  EXPECT_EQ(found.counts.front(), kCount + 1);
}

}  // namespace
}  // namespace galactic::bake::column_strip_test
