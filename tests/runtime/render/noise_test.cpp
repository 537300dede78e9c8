// Noise of images: what it does to pixels, and what it depends on.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "render/noise/noise_kernels.h"
#include "support/packs/render_model_builder.h"
#include "support/processor.h"
#include "support/render_images.h"

namespace galactic::test::noise_test {
namespace {

using render::ColorNoise;
using render::DepthNoise;
using render::PixelKey;

constexpr std::size_t kMany = 1U << 18U;
/// Of means and shares of so many numbers, in standard deviations of theirs. Seeds are fixed: this
/// tells a wrong formula from chance.
constexpr double kChance = 4;
constexpr PixelKey kKey{{0x12345678, 0x9ABCDEF0, 0x0F1E2D3C, 0x4B5A6978}};

struct Moments {
  double mean = 0;
  double deviation = 0;
};

Moments momentsOf(const std::vector<double>& values) {
  Moments moments;
  for (const double value : values) moments.mean += value;
  moments.mean /= static_cast<double>(values.size());
  for (const double value : values) {
    moments.deviation += (value - moments.mean) * (value - moments.mean);
  }
  moments.deviation = std::sqrt(moments.deviation / static_cast<double>(values.size()));
  return moments;
}

/// What noise of deviation 1 has added to so many pixels 1 m away.
std::vector<double> drawnWith(const PixelKey& key, std::size_t count) {
  // At a distance where what is added to it is not rounded much.
  constexpr float kSmall = 1.0F / 1024;
  std::vector<float> depth(count, 1.0F);
  render::addDepthNoisePortable({key, kSmall, 0, 0.05F}, depth.data(), count);
  std::vector<double> drawn;
  drawn.reserve(count);
  for (const float one : depth) {
    drawn.push_back((static_cast<double>(one) - 1) / static_cast<double>(kSmall));
  }
  return drawn;
}

double correlation(const std::vector<double>& a, const std::vector<double>& b, std::size_t shift) {
  double sum = 0;
  for (std::size_t n = 0; n + shift < a.size(); ++n) sum += a[n] * b[n + shift];
  return sum / static_cast<double>(a.size() - shift);
}

TEST(DepthNoise, IsNearlyNormal) {
  const std::vector<double> drawn = drawnWith(kKey, kMany);
  const Moments moments = momentsOf(drawn);
  EXPECT_NEAR(moments.mean, 0, kChance / std::sqrt(kMany));
  EXPECT_NEAR(moments.deviation, 1, 0.005);
  const auto share = [&](double below) {
    const auto count = std::ranges::count_if(drawn, [=](double one) { return one < below; });
    return static_cast<double>(count) / static_cast<double>(drawn.size());
  };
  // The distribution function of a sum of four uniform numbers is within 1 % of the normal one.
  for (double below = -3; below <= 3; below += 0.25) {
    EXPECT_NEAR(share(below), 0.5 * std::erfc(-below / std::numbers::sqrt2), 0.01) << below;
  }
  EXPECT_EQ(share(-3.5), 0);
  EXPECT_EQ(share(3.5), 1);
}

TEST(DepthNoise, OfPixelsAndImagesHasNothingToDoWithThatOfOthers) {
  const double chance = kChance / std::sqrt(kMany);
  const std::vector<double> drawn = drawnWith(kKey, kMany);
  for (const std::size_t shift : {1U, 2U, 8U, 63U, 64U, 65U, 128U}) {
    EXPECT_NEAR(correlation(drawn, drawn, shift), 0, chance) << shift << " pixels away";
  }
  // The second and the third word make one half of each number, the last one decides about dropout.
  const std::array<double, 3> common{0.5, 0.5, 1};
  for (std::size_t word = 1; word < 4; ++word) {
    PixelKey other = kKey;
    ++other.words[word];
    const std::vector<double> others = drawnWith(other, kMany);
    EXPECT_NEAR(correlation(drawn, others, 0), common.at(word - 1), 2 * chance) << word;
    EXPECT_NEAR(correlation(drawn, others, 1), 0, chance) << word;
  }
}

TEST(DepthNoise, GrowsWithTheSquareOfDepth) {
  constexpr float kDeviation = 0.003F;
  for (const float meters : {0.3F, 1.0F, 2.5F, 8.0F}) {
    std::vector<float> depth(kMany, meters);
    render::addDepthNoisePortable({kKey, kDeviation, 0, 0.05F}, depth.data(), depth.size());
    const Moments moments = momentsOf({depth.begin(), depth.end()});
    const double wanted = 0.003 * static_cast<double>(meters) * static_cast<double>(meters);
    EXPECT_NEAR(moments.deviation, wanted, 0.01 * wanted) << meters << " m";
    EXPECT_NEAR(moments.mean, static_cast<double>(meters), 0.01 * wanted) << meters << " m";
  }
}

TEST(DepthNoise, LeavesBackgroundAndNeverComesNearerThanTheNearPlane) {
  constexpr float kNear = 0.4F;
  std::vector<float> depth;
  for (std::size_t n = 0; n < kMany; ++n) {
    depth.push_back(n % 3 == 0 ? 0.0F : n % 3 == 1 ? 0.41F : 6.0F);
  }
  // So much that it would often lead behind the camera.
  render::addDepthNoisePortable({kKey, 1.0F, 0, kNear}, depth.data(), depth.size());
  std::size_t at_near = 0;
  for (std::size_t n = 0; n < kMany; ++n) {
    if (n % 3 == 0) {
      ASSERT_EQ(depth[n], 0);
    } else {
      ASSERT_GE(depth[n], kNear);
      at_near += depth[n] == kNear ? 1U : 0U;
    }
  }
  EXPECT_GT(at_near, kMany / 10);
  EXPECT_LT(at_near, kMany / 2);
}

TEST(DepthNoise, DropsTheShareOfPixelsThatWasAskedForAndLeavesTheOthersAlone) {
  for (const double share : {0.0, 0.01, 0.3, 1.0}) {
    std::vector<float> depth(kMany, 3.0F);
    const auto dropped = static_cast<std::int32_t>(share * 0x1p24);
    render::addDepthNoisePortable({kKey, 0, dropped, 0.05F}, depth.data(), depth.size());
    const auto gone = static_cast<double>(std::ranges::count(depth, 0.0F));
    const double deviation = std::sqrt(share * (1 - share) * kMany);
    EXPECT_NEAR(gone, share * kMany, kChance * deviation) << share;
    EXPECT_EQ(std::ranges::count(depth, 3.0F), static_cast<std::ptrdiff_t>(kMany) - gone);
  }
}

TEST(ColorNoise, HasTheDeviationThatWasAskedForInEachChannel) {
  std::vector<std::uint8_t> color(3 * kMany);
  for (std::size_t n = 0; n < color.size(); ++n) color[n] = static_cast<std::uint8_t>(90 + n % 3);
  render::addColorNoisePortable({kKey, 5.0F, 1.0F}, color.data(), 3, kMany);
  std::array<std::vector<double>, 3> channels;
  for (std::size_t n = 0; n < color.size(); ++n) channels.at(n % 3).push_back(color[n]);
  for (std::size_t c = 0; c < 3; ++c) {
    const Moments moments = momentsOf(channels.at(c));
    EXPECT_NEAR(moments.mean, 90.0 + static_cast<double>(c), kChance * 5 / std::sqrt(kMany));
    // Rounding adds a twelfth of a level to the variance.
    EXPECT_NEAR(moments.deviation, std::sqrt(25 + 1.0 / 12), 0.05);
    for (double& one : channels.at(c)) one -= moments.mean;
  }
  EXPECT_NEAR(correlation(channels[0], channels[1], 0), 0, kChance * 25 / std::sqrt(kMany));
  EXPECT_NEAR(correlation(channels[1], channels[2], 0), 0, kChance * 25 / std::sqrt(kMany));
}

TEST(ColorNoise, MultipliesByTheGainAndStaysWithinTheLevels) {
  std::vector<std::uint8_t> color;
  for (int level = 0; level < 256; ++level) {
    color.insert(color.end(), 3, static_cast<std::uint8_t>(level));
  }
  for (const float gain : {0.0F, 0.5F, 1.0F, 1.7F}) {
    std::vector<std::uint8_t> lit = color;
    render::addColorNoisePortable({kKey, 0, gain}, lit.data(), 3, 256);
    for (std::size_t n = 0; n < color.size(); ++n) {
      const float wanted = std::min(255.0F, std::floor(gain * static_cast<float>(color[n]) + 0.5F));
      ASSERT_EQ(lit[n], wanted) << "level " << int{color[n]} << " by " << gain;
    }
  }
  std::vector<std::uint8_t> noisy = color;
  render::addColorNoisePortable({kKey, 255, 1}, noisy.data(), 3, 256);
  EXPECT_THAT(noisy, testing::Contains(0));
  EXPECT_THAT(noisy, testing::Contains(255));
}

TEST(ColorNoise, IsThatOfThreeChannelsWithFourAndLeavesAlphaAndWhatIsBeyond) {
  constexpr std::uint8_t kBeyond = 0x5A;
  std::mt19937 random(4711);
  for (std::size_t count = 1; count < 70; ++count) {
    std::vector<std::uint8_t> three(3 * count);
    std::vector<std::uint8_t> four;
    for (std::size_t n = 0; n < three.size(); ++n) {
      three[n] = static_cast<std::uint8_t>(random());
      four.push_back(three[n]);
      if (n % 3 == 2) four.push_back(static_cast<std::uint8_t>(random() % 2 * 255));
    }
    const std::vector<std::uint8_t> before = four;
    for (auto* colors : {&three, &four}) colors->insert(colors->end(), 8, kBeyond);
    const ColorNoise noise{kKey, 9.0F, 1.1F};
    render::addColorNoisePortable(noise, three.data(), 3, count);
    render::addColorNoisePortable(noise, four.data(), 4, count);
    for (std::size_t n = 0; n < count; ++n) {
      for (std::size_t c = 0; c < 3; ++c) ASSERT_EQ(three[3 * n + c], four[4 * n + c]);
      ASSERT_EQ(four[4 * n + 3], before[4 * n + 3]);
    }
    for (const auto* colors : {&three, &four}) {
      ASSERT_EQ(std::count(colors->end() - 8, colors->end(), kBeyond), 8) << count << " pixels";
    }
  }
}

TEST(ImageNoise, HasTheSameBitsOnEveryProcessor) {
  if (!detail::hasAvx2()) GTEST_SKIP() << "this processor has no AVX2";
  std::mt19937 random(815);
  for (std::size_t count = 1; count < 5000; count = count < 40 ? count + 1 : count * 3 + 1) {
    std::vector<float> depth;
    for (std::size_t n = 0; n < count; ++n) {
      depth.push_back(random() % 4 == 0 ? 0.0F : uniform(random, 0.05F, 12));
    }
    std::vector<float> depth_avx2 = depth;
    const DepthNoise deep{kKey, 0.02F, 1 << 20, 0.05F};
    render::addDepthNoisePortable(deep, depth.data(), count);
    render::addDepthNoiseAvx2(deep, depth_avx2.data(), count);
    ASSERT_EQ(depth_avx2, depth) << count << " pixels";
    for (const std::uint32_t channels : {3U, 4U}) {
      std::vector<std::uint8_t> color(count * channels);
      for (std::uint8_t& one : color) one = static_cast<std::uint8_t>(random());
      std::vector<std::uint8_t> color_avx2 = color;
      const ColorNoise colored{kKey, 17.3F, 0.9F};
      render::addColorNoisePortable(colored, color.data(), channels, count);
      render::addColorNoiseAvx2(colored, color_avx2.data(), channels, count);
      ASSERT_EQ(color_avx2, color) << count << " pixels";
    }
  }
}

/// A triangle that fills part of what cameras see.
class NoisyImages : public testing::Test {
 protected:
  static constexpr std::size_t kViews = 9;
  static constexpr std::uint32_t kWidth = 37;
  static constexpr std::uint32_t kHeight = 29;
  static constexpr std::size_t kPixels = std::size_t{kWidth} * kHeight;

  void SetUp() override {
    builder_.semantic("triangle");
    builder_.model();
    const auto corner = [](float y, float z) { return RenderVertex{{2, y, z}, 0, 0, 0xFF808080}; };
    builder_.triangle({corner(-2, -2), corner(-2, 2), corner(2, 0)},
                      {.material = builder_.material(0xFF6080A0), .two_sided = true});
    builder_.finish();
    library_.add(builder_.meshes());
    for (std::size_t n = 0; n < kViews; ++n) {
      views_[n].instances = {&instance_, 1};
      views_[n].noise = {
          .moment = {.seed = 3, .env = static_cast<std::uint32_t>(n), .step = 5, .episode = 2},
          .camera = 77};
    }
  }

  static RenderOptions optionsWith(const ImageNoise& noise, std::uint32_t threads = 1) {
    RenderOptions options;
    options.width = kWidth;
    options.height = kHeight;
    options.semantics = true;
    options.background = 0x00302010;
    options.backend = RenderBackend::kSoft;
    options.threads = threads;
    options.noise = noise;
    return options;
  }

  RenderImages draw(const ImageNoise& noise) {
    return renderViews(library_, optionsWith(noise), views_);
  }

  static constexpr ImageNoise kAll{
      .depth_noise = 0.01F, .depth_dropout = 0.1F, .color_noise = 6, .light_jitter = 0.5F};

  RenderModelBuilder builder_{1.0F / 1024};
  RenderLibrary library_;
  RenderInstance instance_;
  std::array<RenderView, kViews> views_;
};

TEST_F(NoisyImages, AreThoseWithoutWhereAllIsOff) {
  const RenderImages plain = draw({});
  for (RenderView& view : views_) view.noise = {};
  EXPECT_EQ(draw({}), plain);
  std::size_t seen = 0;
  for (const float depth : plain.depth) seen += depth > 0 ? 1U : 0U;
  EXPECT_GT(seen, plain.depth.size() / 10);
  EXPECT_LT(seen, plain.depth.size() * 9 / 10);
}

TEST_F(NoisyImages, ChangeInDepthAndColorButNotInWhatIsThere) {
  const RenderImages plain = draw({});
  const RenderImages noisy = draw(kAll);
  EXPECT_EQ(noisy.semantics, plain.semantics);
  std::size_t dropped = 0;
  std::size_t seen = 0;
  for (std::size_t n = 0; n < plain.depth.size(); ++n) {
    ASSERT_EQ(noisy.color[4 * n + 3], plain.color[4 * n + 3]);
    if (plain.depth[n] == 0) {
      ASSERT_EQ(noisy.depth[n], 0);
      continue;
    }
    ++seen;
    dropped += noisy.depth[n] == 0 ? 1U : 0U;
    if (noisy.depth[n] != 0) {
      const float most = 3.5F * kAll.depth_noise.most * plain.depth[n] * plain.depth[n];
      ASSERT_NEAR(noisy.depth[n], plain.depth[n], most);
    }
  }
  EXPECT_NEAR(static_cast<double>(dropped) / static_cast<double>(seen), 0.1, 0.02);
}

TEST_F(NoisyImages, DependOnNeitherThreadsNorBatchNorOrder) {
  const RenderImages images = draw(kAll);
  for (const std::uint32_t threads : {1U, 2U, 5U}) {
    BatchRenderer renderer = makeRenderer(library_, optionsWith(kAll, threads));
    for (int round = 0; round < 3; ++round) {
      EXPECT_EQ(renderViews(renderer, views_), images) << threads << " threads";
    }
    for (std::size_t n = kViews; n-- > 0;) {
      const RenderImages one = renderViews(renderer, {&views_.at(n), 1});
      EXPECT_TRUE(
          std::equal(one.depth.begin(), one.depth.end(), images.depth.data() + n * kPixels));
      EXPECT_TRUE(
          std::equal(one.color.begin(), one.color.end(), images.color.data() + 4 * n * kPixels));
    }
  }
}

TEST_F(NoisyImages, OfTwoHalvesAreTheSame) {
  BatchRenderer renderer = makeRenderer(library_, optionsWith(kAll));
  RenderImages images = emptyImages(renderer.options(), kViews);
  renderer.beginRender(views_, targetsOf(images));
  renderer.endRender();
  EXPECT_EQ(images, draw(kAll));
}

TEST_F(NoisyImages, FollowFromSeedEnvEpisodeStepAndCamera) {
  const ImageNoise grainy{.depth_noise = 0.01F, .color_noise = 6};
  const ImageNoise lit{.light_jitter = 0.5F};
  const RenderImages first = draw(grainy);
  const RenderImages first_lit = draw(lit);
  struct Change {
    std::function<void(NoiseSource&)> make;
    bool is_of_light;
  };
  const std::vector<Change> changes{
      {[](NoiseSource& source) { ++source.moment.seed; }, true},
      {[](NoiseSource& source) { source.moment.env += 100; }, true},
      {[](NoiseSource& source) { ++source.moment.episode; }, true},
      {[](NoiseSource& source) { ++source.moment.step; }, false},
      {[](NoiseSource& source) { ++source.camera; }, false},
  };
  for (std::size_t n = 0; n < changes.size(); ++n) {
    const auto before = views_;
    for (RenderView& view : views_) changes[n].make(view.noise);
    const RenderImages other = draw(grainy);
    EXPECT_NE(other.depth, first.depth) << "change " << n;
    EXPECT_NE(other.color, first.color) << "change " << n;
    EXPECT_EQ(draw(lit).color != first_lit.color, changes[n].is_of_light) << "change " << n;
    views_ = before;
  }
  // Envs are lit by lights of their own.
  EXPECT_FALSE(std::equal(first_lit.color.begin(), first_lit.color.begin() + 4 * kPixels,
                          first_lit.color.begin() + 4 * kPixels));
}

TEST_F(NoisyImages, OfARangeAreThoseOfTheNumbersThatEpisodesHaveDrawn) {
  constexpr ImageNoise kRanges{.depth_noise = {0.001F, 0.05F},
                               .depth_dropout = {0.05F, 0.5F},
                               .color_noise = {1, 30},
                               .light_jitter = {0.1F, 0.6F}};
  const RenderImages images = draw(kRanges);
  for (std::size_t n = 0; n < kViews; ++n) {
    const RenderImages numbers = draw(episodeImageNoise(kRanges, views_.at(n).noise));
    const auto same = [&](const auto& one, const auto& other, std::size_t size) {
      const auto begin = static_cast<std::ptrdiff_t>(n * size);
      return std::equal(one.begin() + begin,
                        one.begin() + begin + static_cast<std::ptrdiff_t>(size),
                        other.begin() + begin);
    };
    EXPECT_TRUE(same(images.depth, numbers.depth, kPixels)) << n;
    EXPECT_TRUE(same(images.color, numbers.color, 4 * kPixels)) << n;
    // Others have drawn other numbers.
    const std::size_t next = (n + 1) % kViews;
    EXPECT_NE(images, draw(episodeImageNoise(kRanges, views_.at(next).noise)));
  }
}

TEST(EpisodeImageNoise, IsDrawnFromTheWholeRangeByEnvEpisodeSeedAndCamera) {
  constexpr ImageNoise kRanges{.depth_noise = {0.25F, 0.75F},
                               .depth_dropout = {0.25F, 0.75F},
                               .color_noise = {0.25F, 0.75F},
                               .light_jitter = {0.25F, 0.75F}};
  constexpr std::size_t kDraws = 4000;
  std::array<std::vector<double>, 4> drawn;
  for (std::uint32_t n = 0; n < kDraws; ++n) {
    NoiseSource source{.moment = {.seed = 7, .env = n % 50, .step = 3, .episode = n / 50},
                       .camera = 12};
    const ImageNoise noise = episodeImageNoise(kRanges, source);
    const std::array<DrawnNumber, 4> numbers{noise.depth_noise, noise.depth_dropout,
                                             noise.color_noise, noise.light_jitter};
    for (std::size_t k = 0; k < numbers.size(); ++k) {
      ASSERT_FALSE(numbers.at(k).isRange());
      ASSERT_GE(numbers.at(k).least, 0.25F);
      ASSERT_LE(numbers.at(k).least, 0.75F);
      drawn.at(k).push_back(static_cast<double>(numbers.at(k).least) - 0.5);
    }
    // All of an episode, and light in all its cameras.
    source.moment.step = 400;
    ASSERT_EQ(episodeImageNoise(kRanges, source).depth_noise, noise.depth_noise);
    source.camera = 13;
    const ImageNoise of_another = episodeImageNoise(kRanges, source);
    ASSERT_NE(of_another.depth_noise, noise.depth_noise);
    ASSERT_NE(of_another.color_noise, noise.color_noise);
    ASSERT_EQ(of_another.light_jitter, noise.light_jitter);
    source.moment.seed = 8;
    ASSERT_NE(episodeImageNoise(kRanges, source).light_jitter, noise.light_jitter);
  }
  for (std::size_t k = 0; k < drawn.size(); ++k) {
    const Moments moments = momentsOf(drawn.at(k));
    EXPECT_NEAR(moments.mean, 0, kChance * 0.5 / std::sqrt(12.0 * kDraws)) << k;
    EXPECT_NEAR(moments.deviation, 0.5 / std::sqrt(12.0), 0.01) << k;
    for (std::size_t other = 0; other < k; ++other) {
      const double covariance = correlation(drawn.at(k), drawn.at(other), 0);
      EXPECT_NEAR(covariance, 0, kChance / 48 / std::sqrt(static_cast<double>(kDraws)));
    }
  }
  // A number is no draw.
  EXPECT_EQ(episodeImageNoise({.color_noise = 4}, {}).color_noise, DrawnNumber(4));
}

TEST_F(NoisyImages, OfConsecutiveStepsEnvsEpisodesAndSeedsHaveNothingInCommon) {
  const RenderImages plain = draw({});
  const auto drawn = [&] {
    const RenderImages noisy = draw({.depth_noise = 0.01F});
    std::vector<double> values;
    for (std::size_t n = 0; n < plain.depth.size(); ++n) {
      if (plain.depth[n] == 0) continue;
      values.push_back(static_cast<double>(noisy.depth[n] - plain.depth[n]) /
                       static_cast<double>(0.01F * plain.depth[n] * plain.depth[n]));
    }
    return values;
  };
  const std::vector<double> first = drawn();
  const double chance = kChance / std::sqrt(static_cast<double>(first.size()));
  EXPECT_NEAR(correlation(first, first, 0), 1, 0.1);
  const auto before = views_;
  const std::vector<std::function<void(EnvMoment&)>> changes{
      [](EnvMoment& moment) { ++moment.step; }, [](EnvMoment& moment) { ++moment.env; },
      [](EnvMoment& moment) { ++moment.episode; }, [](EnvMoment& moment) { ++moment.seed; }};
  for (const auto& change : changes) {
    for (RenderView& view : views_) change(view.noise.moment);
    EXPECT_NEAR(correlation(first, drawn(), 0), 0, chance);
    views_ = before;
  }
}

TEST_F(NoisyImages, AreRefusedWhereTheyCannotBe) {
  const auto refusal = [&](const std::function<void(RenderOptions&)>& change) {
    RenderOptions options = optionsWith({});
    change(options);
    const auto made = BatchRenderer::create(library_, options);
    if (made) return std::string();
    EXPECT_EQ(made.error().code, ErrorCode::kInvalidInput);
    return made.error().text();
  };
  const auto or_range = [](const std::string& most) {
    return ", or a range from 0 to " + most + " such as 0.1-0.3";
  };
  EXPECT_EQ(refusal([](RenderOptions& o) { o.noise = {1, 1, 255, 1}; }), "");
  EXPECT_EQ(refusal([](RenderOptions& o) { o.noise.color_noise = {0, 255}; }), "");
  EXPECT_EQ(refusal([](RenderOptions& o) { o.noise.depth_noise = 1.5F; }),
            "render options: found depth-noise of 1.5, expected 0 to 1" + or_range("1"));
  EXPECT_EQ(refusal([](RenderOptions& o) {
              o.noise.depth_noise = {0.2F, 0.1F};
            }),
            "render options: found depth-noise of 0.2-0.1, expected 0 to 1" + or_range("1"));
  EXPECT_EQ(refusal([](RenderOptions& o) {
              o.noise.depth_noise = {-0.25F, 0.5F};
            }),
            "render options: found depth-noise of -0.25-0.5, expected 0 to 1" + or_range("1"));
  EXPECT_EQ(refusal([](RenderOptions& o) { o.noise.depth_dropout = -0.25F; }),
            "render options: found depth-dropout of -0.25, expected 0 to 1" + or_range("1"));
  EXPECT_EQ(refusal([](RenderOptions& o) { o.noise.color_noise = 256; }),
            "render options: found color-noise of 256, expected 0 to 255" + or_range("255"));
  EXPECT_EQ(refusal([](RenderOptions& o) {
              o.noise.light_jitter = std::numeric_limits<float>::quiet_NaN();
            }),
            "render options: found light-jitter of nan-nan, expected 0 to 1" + or_range("1"));
  EXPECT_EQ(refusal([](RenderOptions& o) {
              o.depth = false;
              o.noise.depth_dropout = 0.1F;
            }),
            "render options: found noise or dropout of depth, and no depth images; draw depth, or "
            "leave it out");
  EXPECT_EQ(refusal([](RenderOptions& o) {
              o.color = ColorFormat::kNone;
              o.noise.light_jitter = 0.1F;
            }),
            "render options: found noise or jitter of colors, and no color images; draw color, or "
            "leave it out");
  BatchRenderer renderer = makeRenderer(library_, optionsWith(kAll));
  const auto on_device = renderer.renderToDevice(views_);
  ASSERT_FALSE(on_device);
  EXPECT_EQ(on_device.error().code, ErrorCode::kUnsupported);
  EXPECT_EQ(
      on_device.error().message,
      "found noise of images, which is added in memory of the processor, and images that stay "
      "on the device; render into memory, or leave the noise out");
}

}  // namespace
}  // namespace galactic::test::noise_test
