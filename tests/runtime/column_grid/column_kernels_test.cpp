// The batched kernels against the scalar query: equal bit for bit, on anything.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "column_grid/column_grid_kernels.h"
#include "support/packs/grid_builder.h"
#include "support/processor.h"
#include "support/sanitized.h"

namespace galactic::test::column_kernels_test {
namespace {

/// Draws coordinates: mostly inside a range, often exactly at or next to a cell border or the
/// range's ends, sometimes no sensible number at all.
class CoordinateSource {
 public:
  CoordinateSource(float lo, float hi, float step) : lo_(lo), hi_(hi), step_(step) {}

  float operator()(std::mt19937& random) const {
    const auto kind = random() % 256;
    if (kind < 2) return special(random);
    if (kind < 12) return std::bit_cast<float>(static_cast<std::uint32_t>(random()));
    const float inside = std::uniform_real_distribution<float>(lo_, hi_)(random);
    if (kind < 32) return lo_ + std::floor((inside - lo_) / step_) * step_;
    if (kind < 36) return std::nextafter(lo_, kind % 2 == 0 ? hi_ : -hi_);
    if (kind < 40) return std::nextafter(hi_, kind % 2 == 0 ? lo_ : 2 * hi_);
    if (kind < 42) return kind % 2 == 0 ? lo_ : hi_;
    return inside;
  }

 private:
  static float special(std::mt19937& random) {
    using Limits = std::numeric_limits<float>;
    const float values[] = {
        Limits::quiet_NaN(), -Limits::quiet_NaN(), Limits::infinity(),   -Limits::infinity(),
        Limits::max(),       Limits::lowest(),     Limits::denorm_min(), -0.0F,
        2147483648.0F,       -2147483648.0F,       4294967296.0F,        1e20F};
    return values[random() % std::size(values)];
  }

  float lo_;
  float hi_;
  float step_;
};

struct Queries {
  std::vector<float> x, y, z;
};

Queries drawQueries(const GridSpec& spec, std::size_t count, std::mt19937& random) {
  const CoordinateSource x(
      spec.min_x, spec.min_x + static_cast<float>(spec.columns_x) * spec.spacing, spec.spacing);
  const CoordinateSource z(
      spec.min_z, spec.min_z + static_cast<float>(spec.columns_z) * spec.spacing, spec.spacing);
  const CoordinateSource y(spec.heights.lo, spec.heights.hi, spec.quantum);
  Queries queries;
  for (std::size_t n = 0; n < count; ++n) {
    queries.x.push_back(x(random));
    queries.y.push_back(y(random));
    queries.z.push_back(z(random));
  }
  return queries;
}

struct Answers {
  explicit Answers(std::size_t count)
      : clearance(count, static_cast<Clearance>(77)), down(count, -77), up(count, -77) {}

  std::vector<Clearance> clearance;
  std::vector<float> down, up;
};

detail::ContactBatch batchOf(const Queries& queries, Answers& answers) {
  return {queries.x.data(),         queries.y.data(),    queries.z.data(), queries.x.size(),
          answers.clearance.data(), answers.down.data(), answers.up.data()};
}

bool sameBits(float a, float b) {
  return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
}

void expectSame(const Queries& queries, const Answers& a, const Answers& b) {
  for (std::size_t n = 0; n < queries.x.size(); ++n) {
    ASSERT_EQ(a.clearance[n], b.clearance[n])
        << queries.x[n] << " " << queries.y[n] << " " << queries.z[n];
    ASSERT_TRUE(sameBits(a.down[n], b.down[n]) && sameBits(a.up[n], b.up[n]))
        << queries.x[n] << " " << queries.y[n] << " " << queries.z[n];
  }
}

Answers answerOneByOne(const ColumnGrid& grid, const Queries& queries) {
  Answers answers(queries.x.size());
  for (std::size_t n = 0; n < queries.x.size(); ++n) {
    const Vec3 center{queries.x[n], queries.y[n], queries.z[n]};
    const Contact contact = grid.contact(center);
    EXPECT_EQ(grid.clearance(center), contact.clearance);
    answers.clearance[n] = contact.clearance;
    answers.down[n] = contact.down;
    answers.up[n] = contact.up;
  }
  return answers;
}

/// How often each answer was given.
struct Tally {
  std::size_t free = 0, blocked = 0, outside = 0;

  void add(const Answers& answers) {
    for (const Clearance clearance : answers.clearance) {
      free += clearance == Clearance::kFree ? 1 : 0;
      blocked += clearance == Clearance::kBlocked ? 1 : 0;
      outside += clearance == Clearance::kOutside ? 1 : 0;
    }
  }
};

GridSpec roomSpec() {
  return {.radius = 0.05F,
          .spacing = 0.03F,
          .min_x = -2.66F,
          .min_z = -4.76F,
          .heights = {-0.1F, 3.1F},
          .quantum = 9.5e-5F,
          .columns_x = 61,
          .columns_z = 47};
}

GridSpec towerSpec() {
  GridSpec spec = roomSpec();
  spec.heights = {-3, 22.5F};
  return spec;
}

/// Up to 64 centers at a time, some of their eights: the clearances as bits.
void compareNotFree(const ColumnGridLayout& grid, const Queries& queries, const Answers& answers,
                    std::mt19937& random) {
  constexpr std::size_t kMost = 64;
  for (std::size_t first = 0; first + kMost <= queries.x.size(); first += kMost) {
    const detail::EightsOfCenters centers{queries.x.data() + first, queries.y.data() + first,
                                          queries.z.data() + first,
                                          static_cast<unsigned>(random() % 256)};
    std::uint64_t expected = 0;
    for (std::size_t n = 0; n < kMost; ++n) {
      const bool is_asked = (centers.eights >> n / 8 & 1U) != 0;
      const bool is_free = answers.clearance[first + n] == Clearance::kFree;
      expected |= std::uint64_t{is_asked && !is_free} << n;
    }
    ASSERT_EQ(detail::notFreePortable(grid, centers), expected);
    if (!detail::hasAvx2()) continue;
    ASSERT_EQ(detail::notFreeAvx2(grid, centers), expected);
  }
}

void compareKernels(const GridSpec& spec, std::uint32_t seed, std::size_t count) {
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  std::mt19937 random(seed);
  const TestGrid grid = randomGrid(spec, random);
  ASSERT_FALSE(grid.overflow_codes.empty() && grid.overflow_spans.empty());
  const ColumnGrid view = grid.view();
  const Queries queries = drawQueries(spec, count, random);
  const Answers scalar = answerOneByOne(view, queries);
  Answers portable(count);
  detail::contactPortable(view.layout(), batchOf(queries, portable));
  expectSame(queries, scalar, portable);
  Answers chosen(count);
  view.contact({queries.x, queries.y, queries.z}, {chosen.clearance, chosen.down, chosen.up});
  expectSame(queries, scalar, chosen);
  compareNotFree(view.layout(), queries, scalar, random);
  if (detail::hasAvx2()) {
    Answers vectorised(count);
    detail::contactAvx2(view.layout(), batchOf(queries, vectorised));
    expectSame(queries, scalar, vectorised);
  }
  Tally tally;
  tally.add(scalar);
  for (const std::size_t answers : {tally.free, tally.blocked, tally.outside}) {
    EXPECT_GT(answers, count / 10);
    EXPECT_LT(answers, count * 9 / 10);
  }
}

constexpr std::size_t kQueries = kIsSanitized ? 100'000 : 2'000'000;

TEST(ColumnKernels, AnswerMillionsOfQueriesOfARoomBitForBitAlike) {
  compareKernels(roomSpec(), 201, kQueries);
}

TEST(ColumnKernels, AnswerMillionsOfQueriesOfATallBuildingBitForBitAlike) {
  ASSERT_FALSE(GridBuilder(towerSpec()).build().tile_base.empty());
  compareKernels(towerSpec(), 202, kQueries);
}

TEST(ColumnKernels, AgreeOnGridsOfAnyShape) {
  for (std::uint32_t columns_x = 1; columns_x <= 9; ++columns_x) {
    for (std::uint32_t columns_z = 1; columns_z <= 5; ++columns_z) {
      for (GridSpec spec : {roomSpec(), towerSpec()}) {
        spec.columns_x = columns_x;
        spec.columns_z = columns_z;
        const std::uint32_t seed = 1000 * columns_x + columns_z;
        SCOPED_TRACE(testing::Message() << "seed " << seed);
        std::mt19937 random(seed);
        const TestGrid grid = randomGrid(spec, random);
        const Queries queries = drawQueries(spec, 803, random);
        const Answers scalar = answerOneByOne(grid.view(), queries);
        Answers batched(queries.x.size());
        grid.view().contact({queries.x, queries.y, queries.z},
                            {batched.clearance, batched.down, batched.up});
        expectSame(queries, scalar, batched);
      }
    }
  }
}

TEST(ColumnKernels, AnswerBatchesOfAnyLengthAndWriteNothingBeyond) {
  std::mt19937 random(203);
  const TestGrid grid = randomGrid(roomSpec(), random);
  const Queries queries = drawQueries(roomSpec(), 64, random);
  const Answers scalar = answerOneByOne(grid.view(), queries);
  for (std::size_t count = 0; count <= 40; ++count) {
    Answers batched(64);
    const auto first = [count](auto& values) { return std::span(values).first(count); };
    grid.view().contact({first(queries.x), first(queries.y), first(queries.z)},
                        {first(batched.clearance), first(batched.down), first(batched.up)});
    for (std::size_t n = 0; n < 64; ++n) {
      const bool answered = n < count;
      EXPECT_EQ(batched.clearance[n], answered ? scalar.clearance[n] : static_cast<Clearance>(77));
      EXPECT_TRUE(sameBits(batched.down[n], answered ? scalar.down[n] : -77));
      EXPECT_TRUE(sameBits(batched.up[n], answered ? scalar.up[n] : -77));
    }
  }
}

TEST(ColumnKernels, AnswerTheClearanceAloneWhenNoDistancesAreWanted) {
  std::mt19937 random(204);
  const TestGrid grid = randomGrid(roomSpec(), random);
  const Queries queries = drawQueries(roomSpec(), 1003, random);
  const Answers scalar = answerOneByOne(grid.view(), queries);
  Answers batched(queries.x.size());
  grid.view().contact({queries.x, queries.y, queries.z}, {batched.clearance, {}, {}});
  EXPECT_EQ(batched.clearance, scalar.clearance);
  std::fill(batched.clearance.begin(), batched.clearance.end(), Clearance::kFree);
  const detail::ContactBatch batch{queries.x.data(), queries.y.data(),         queries.z.data(),
                                   queries.x.size(), batched.clearance.data(), nullptr,
                                   nullptr};
  detail::contactPortable(grid.view().layout(), batch);
  EXPECT_EQ(batched.clearance, scalar.clearance);
}

}  // namespace
}  // namespace galactic::test::column_kernels_test
