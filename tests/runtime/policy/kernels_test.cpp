// The kernels of networks: those for AVX2 and those for any processor agree bit for bit, and both
// agree with the library's functions.
#include "policy/kernels.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <random>
#include <vector>

#include "support/processor.h"

namespace galactic::policy::kernels_test {
namespace {

std::vector<float> numbers(std::size_t count, unsigned seed, float scale = 2) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> any(-scale, scale);
  std::vector<float> values(count);
  for (float& value : values) value = any(random);
  return values;
}

/// Each kernel on the same input.
class KernelPair : public testing::Test {
 protected:
  void SetUp() override {
    if (!detail::hasFusedAvx2()) GTEST_SKIP() << "this processor has no AVX2 with FMA";
  }
  /// `run(kernels, out)` fills `count` floats with either.
  template <class Run>
  static void expectSame(std::size_t count, const Run& run) {
    std::vector<float> plain(count);
    std::vector<float> fast(count);
    run(portableKernels(), plain.data());
    run(avx2Kernels(), fast.data());
    EXPECT_EQ(std::memcmp(plain.data(), fast.data(), count * sizeof(float)), 0);
  }
};

TEST_F(KernelPair, AgreesOnElements) {
  const std::vector<float> x = numbers(4096, 1, 30);
  const std::vector<float> y = numbers(4096, 2, 30);
  for (const auto kernel : {&Kernels::relu, &Kernels::tanh, &Kernels::exp}) {
    expectSame(x.size(), [&](const Kernels& kernels, float* to) {
      (kernels.*kernel)(x.data(), to, x.size());
    });
  }
  expectSame(x.size(), [&](const Kernels& kernels, float* to) {
    kernels.add(x.data(), y.data(), to, x.size());
  });
}

TEST_F(KernelPair, AgreesOnProductsForAnyNumberOfRows) {
  constexpr std::size_t kRuns = 3;
  constexpr std::size_t kLength = 7;
  constexpr std::size_t kStride = 11;
  const std::vector<float> x = numbers(kRows * 64, 3);
  const std::vector<float> weights = numbers(kRuns * kLength * kPack, 4);
  const std::vector<float> bias = numbers(kPack, 5);
  for (std::size_t rows = 0; rows <= 20; ++rows) {
    for (const std::size_t outputs : {1U, 15U, 16U}) {
      expectSame(rows * outputs + 1, [&](const Kernels& kernels, float* to) {
        std::array<const float*, kRows> from{};
        std::array<float*, kRows> results{};
        for (std::size_t r = 0; r < rows; ++r) {
          from[r] = x.data() + r * 64;
          results[r] = to + r * outputs;
        }
        to[rows * outputs] = 77;
        kernels.multiply({.rows = from.data(),
                          .results = results.data(),
                          .row_count = rows,
                          .runs = kRuns,
                          .run_length = kLength,
                          .run_stride = kStride,
                          .weights = weights.data(),
                          .bias = bias.data(),
                          .outputs = outputs});
        EXPECT_EQ(to[rows * outputs], 77) << "written beyond the results";
      });
    }
  }
}

TEST_F(KernelPair, AgreesOnNormalizationAndGates) {
  struct Channels {
    std::size_t count = 0;
    std::size_t groups = 0;
  };
  for (const Channels& channels : {Channels{32, 16}, Channels{9, 3}, Channels{5, 1}}) {
    constexpr std::size_t kPixels = 13;
    const std::vector<float> x = numbers(kPixels * channels.count, 6);
    const std::vector<float> weight = numbers(channels.count, 7);
    const std::vector<float> bias = numbers(channels.count, 8);
    std::vector<float> scratch(2 * channels.count);
    expectSame(x.size(), [&](const Kernels& kernels, float* to) {
      kernels.normalizeGroups({.from = x.data(),
                               .to = to,
                               .pixels = kPixels,
                               .channels = channels.count,
                               .groups = channels.groups,
                               .epsilon = 1e-5F,
                               .weight = weight.data(),
                               .bias = bias.data(),
                               .scratch = scratch.data()});
    });
  }
  constexpr std::size_t kSize = 24;
  const std::vector<float> input = numbers(3 * kSize, 9, 8);
  const std::vector<float> recurrent = numbers(3 * kSize, 10, 8);
  const std::vector<float> state = numbers(kSize, 11, 1);
  expectSame(kSize, [&](const Kernels& kernels, float* to) {
    kernels.gate({.input = input.data(),
                  .recurrent = recurrent.data(),
                  .state = state.data(),
                  .to = to,
                  .size = kSize});
  });
}

TEST_F(KernelPair, AgreesOnRandomNumbers) {
  std::mt19937 random(12);
  for (int round = 0; round < 1000; ++round) {
    std::array<std::uint32_t, 16> words{};
    for (std::uint32_t& word : words) word = static_cast<std::uint32_t>(random());
    expectSame(16, [&](const Kernels& kernels, float* to) { kernels.gaussians(words.data(), to); });
  }
}

/// The kernel's value of one number.
float one(void (*kernel)(const float*, float*, std::size_t) noexcept, float x) {
  std::array<float, 8> from{};
  from.fill(x);
  std::array<float, 8> to{};
  kernel(from.data(), to.data(), to.size());
  for (const float value : to) EXPECT_EQ(std::memcmp(&value, to.data(), sizeof(value)), 0);
  return to[0];
}

TEST(Kernels, KnowTheExponentialAndTheHyperbolicTangent) {
  const Kernels fast = kernels();
  for (float x = -85; x < 85; x += 0.00917F) {
    const double wanted = std::exp(static_cast<double>(x));
    ASSERT_NEAR(static_cast<double>(one(fast.exp, x)) / wanted, 1, 3e-7) << x;
  }
  for (float x = -12; x < 12; x += 0.00117F) {
    ASSERT_NEAR(static_cast<double>(one(fast.tanh, x)), std::tanh(static_cast<double>(x)), 3e-7)
        << x;
  }
  EXPECT_EQ(one(fast.tanh, 0), 0);
  EXPECT_EQ(one(fast.tanh, 100), 1);
  EXPECT_EQ(one(fast.tanh, -1e30F), -1);
  EXPECT_EQ(one(fast.tanh, std::numeric_limits<float>::infinity()), 1);
  EXPECT_TRUE(std::isnan(one(fast.tanh, std::numeric_limits<float>::quiet_NaN())));
  EXPECT_TRUE(std::isfinite(one(fast.exp, 1e30F)));
  EXPECT_GT(one(fast.exp, -1e30F), 0);
}

TEST(Kernels, DrawNormallyDistributedNumbers) {
  const Kernels fast = kernels();
  std::mt19937 random(13);
  constexpr std::size_t kDraws = 16 * 20000;
  double sum = 0;
  double squares = 0;
  double fourths = 0;
  std::size_t within_one = 0;
  for (std::size_t n = 0; n < kDraws; n += 16) {
    std::array<std::uint32_t, 16> words{};
    for (std::uint32_t& word : words) word = static_cast<std::uint32_t>(random());
    std::array<float, 16> drawn{};
    fast.gaussians(words.data(), drawn.data());
    for (const float value : drawn) {
      const auto x = static_cast<double>(value);
      ASSERT_TRUE(std::isfinite(x));
      sum += x;
      squares += x * x;
      fourths += x * x * x * x;
      within_one += std::abs(x) < 1 ? 1U : 0U;
    }
  }
  constexpr auto kCount = static_cast<double>(kDraws);
  // Six standard errors of each.
  EXPECT_NEAR(sum / kCount, 0, 0.011);
  EXPECT_NEAR(squares / kCount, 1, 0.015);
  EXPECT_NEAR(fourths / kCount, 3, 0.11);
  EXPECT_NEAR(static_cast<double>(within_one) / kCount, 0.682689, 0.005);
}

TEST(Kernels, DrawByTheFormulaOfBoxAndMuller) {
  std::mt19937 random(14);
  for (int round = 0; round < 1000; ++round) {
    std::array<std::uint32_t, 16> words{};
    for (std::uint32_t& word : words) word = static_cast<std::uint32_t>(random());
    if (round == 0) words.fill(0);
    if (round == 1) words.fill(0xFFFFFFFFU);
    std::array<float, 16> drawn{};
    kernels().gaussians(words.data(), drawn.data());
    for (std::size_t n = 0; n < 8; ++n) {
      const double u = std::ldexp(static_cast<double>(words[n] >> 8U) + 1, -24);
      const double angle = 2 * 3.14159265358979 * std::ldexp(words[n + 8] >> 8U, -24);
      const double radius = std::sqrt(-2 * std::log(u));
      ASSERT_NEAR(static_cast<double>(drawn[n]), radius * std::cos(angle), 2e-6);
      ASSERT_NEAR(static_cast<double>(drawn[n + 8]), radius * std::sin(angle), 2e-6);
    }
  }
}

}  // namespace
}  // namespace galactic::policy::kernels_test
