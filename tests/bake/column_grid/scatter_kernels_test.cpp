// All kernels of the exact engine compute the same bits, lane by lane.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include "column_grid/column_strip.h"
#include "column_grid/scatter/scatter.h"
#include "support/oracles/triangle_corners.h"
#include "support/scene_meshes.h"

namespace galactic::bake::scatter_kernels_test {
namespace {

constexpr std::uint32_t kSeed = 20250308;

struct Kernel {
  std::string name;
  ScatterFunction scatter;
};

/// Those that this processor can run.
std::vector<Kernel> kernels() {
  std::vector<Kernel> found{{"portable", scatterPortable}};
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2")) found.push_back({"AVX2", scatterAvx2});
  if (__builtin_cpu_supports("avx512f")) found.push_back({"AVX-512", scatterAvx512});
#endif
  return found;
}

/// A strip over the unit square and where its columns stand.
class TestStrip {
 public:
  static constexpr std::uint32_t kColumns = 37;
  static constexpr std::uint32_t kFirstRow = 3;
  static constexpr std::uint32_t kEndRow = 30;

  TestStrip() : strip_(frame(), kFirstRow, kEndRow) {
    for (std::uint32_t i = 0; i < kColumns + ColumnStrip::kPadding; ++i) {
      const double x = frame().centerX(i);
      x_high_.push_back(static_cast<float>(x));
      x_low_.push_back(static_cast<float>(x - static_cast<double>(x_high_.back())));
    }
    for (std::uint32_t k = 0; k < frame().columns_z; ++k) z_.push_back(frame().centerZ(k));
  }

  void scatter(const Kernel& kernel, const ScatterTriangle& triangle, const ScatterBlock& block,
               float radius) {
    const ScatterTarget target{.lo = strip_.lo(),
                               .hi = strip_.hi(),
                               .first_row = kFirstRow,
                               .stride = strip_.stride(),
                               .x_high = x_high_.data(),
                               .x_low = x_low_.data(),
                               .z = z_.data(),
                               .strip = &strip_};
    kernel.scatter(triangle, block, radius, target);
  }

  /// All bits of the current intervals, padding included.
  [[nodiscard]] std::vector<float> intervals() {
    const std::size_t count = strip_.stride() * (kEndRow - kFirstRow);
    std::vector<float> all(strip_.lo(), strip_.lo() + count);
    all.insert(all.end(), strip_.hi(), strip_.hi() + count);
    return all;
  }

  [[nodiscard]] std::vector<Span> freeSpans(std::vector<std::uint32_t>& counts) const {
    std::vector<Span> spans;
    counts.clear();
    strip_.appendFree(counts, spans);
    return spans;
  }

 private:
  static GridFrame frame() {
    GridFrame frame;
    frame.radius = 0.05F;
    frame.spacing = 0.03F;
    frame.heights = {-2, 3};
    frame.columns_x = kColumns;
    frame.columns_z = 33;
    return frame;
  }

  ColumnStrip strip_;
  std::vector<float> x_high_;
  std::vector<float> x_low_;
  std::vector<double> z_;
};

template <class T>
bool sameBits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

/// Any rectangle of the strip's columns, of every width and alignment.
ScatterBlock randomBlock(std::mt19937& random) {
  const auto below = [&](std::uint32_t count) {
    return static_cast<std::uint32_t>(random() % count);
  };
  ScatterBlock block;
  block.first_row = TestStrip::kFirstRow + below(20);
  block.end_row = std::min(block.first_row + 1 + below(27), TestStrip::kEndRow);
  block.first_column = below(TestStrip::kColumns);
  block.end_column =
      std::min(block.first_column + 1 + below(TestStrip::kColumns), TestStrip::kColumns);
  return block;
}

TEST(ScatterKernels, GiveTheSameBitsOnRandomTriangles) {
  RecordProperty("seed", static_cast<int>(kSeed));
  const std::vector<Kernel> all = kernels();
  if (all.size() < 2) GTEST_SKIP() << "this processor has the portable kernel only";
  std::mt19937 random(kSeed);
  int columns = 0;
  int touched = 0;
  std::size_t spans = 0;
  for (std::uint32_t scene = 0; scene < 60; ++scene) {
    const float radius = std::array{0.015F, 0.05F, 0.12F}[scene % 3];
    std::vector<TestStrip> strips(all.size());
    const TriangleMesh mesh = test::awkwardTriangles(kSeed + scene, 70);
    for (const test::Corners& corners : test::allCorners(mesh)) {
      const ScatterTriangle triangle = prepareTriangle(corners, radius);
      const ScatterBlock block = randomBlock(random);
      for (std::size_t n = 0; n < all.size(); ++n) {
        strips[n].scatter(all[n], triangle, block, radius);
      }
      for (std::size_t n = 1; n < all.size(); ++n) {
        ASSERT_TRUE(sameBits(strips[n].intervals(), strips[0].intervals()))
            << all[n].name << ", seed " << kSeed + scene;
      }
    }
    std::vector<std::uint32_t> counts;
    std::vector<std::uint32_t> expected_counts;
    const std::vector<Span> expected = strips[0].freeSpans(expected_counts);
    for (std::size_t n = 1; n < all.size(); ++n) {
      EXPECT_TRUE(sameBits(strips[n].freeSpans(counts), expected)) << all[n].name;
      EXPECT_EQ(counts, expected_counts) << all[n].name;
    }
    for (const std::uint32_t count : expected_counts) touched += count == 1 ? 0 : 1;
    columns += static_cast<int>(expected_counts.size());
    spans += expected.size();
  }
  EXPECT_GT(touched, columns / 10);
  EXPECT_LT(touched, columns * 9 / 10);
  EXPECT_GT(spans, static_cast<std::size_t>(columns) * 11 / 10) << "lists are hardly used";
}

/// A kernel may load and store beyond a block, but what lies there keeps its bits.
TEST(ScatterKernels, LeaveColumnsOutsideTheBlockAlone) {
  std::mt19937 random(kSeed);
  for (const Kernel& kernel : kernels()) {
    std::size_t written = 0;
    for (int round = 0; round < 300; ++round) {
      const TriangleMesh mesh =
          test::awkwardTriangles(kSeed + static_cast<std::uint32_t>(round), 4);
      const ScatterBlock block = randomBlock(random);
      TestStrip strip;
      const std::vector<float> before = strip.intervals();
      for (const test::Corners& corners : test::allCorners(mesh)) {
        strip.scatter(kernel, prepareTriangle(corners, 0.12F), block, 0.12F);
      }
      const std::vector<float> after = strip.intervals();
      const std::size_t stride = TestStrip::kColumns + ColumnStrip::kPadding;
      for (std::size_t n = 0; n < after.size(); ++n) {
        const std::size_t row =
            n / stride % (TestStrip::kEndRow - TestStrip::kFirstRow) + TestStrip::kFirstRow;
        const std::size_t column = n % stride;
        const bool inside = row >= block.first_row && row < block.end_row &&
                            column >= block.first_column && column < block.end_column;
        ASSERT_TRUE(inside || after[n] == before[n]) << kernel.name << ", round " << round;
        written += after[n] == before[n] ? 0U : 1U;
      }
    }
    EXPECT_GT(written, 0U) << kernel.name << " never wrote into a block";
  }
}

TEST(ScatterKernels, AreChosenAmongThoseThatTheProcessorRuns) {
  const ScatterFunctions chosen = fastestScatter();
  const std::vector<Kernel> all = kernels();
  const auto runs = [&](ScatterFunction function) {
    return std::any_of(all.begin(), all.end(),
                       [&](const Kernel& kernel) { return kernel.scatter == function; });
  };
  EXPECT_TRUE(runs(chosen.narrow));
  EXPECT_TRUE(runs(chosen.wide));
}

}  // namespace
}  // namespace galactic::bake::scatter_kernels_test
