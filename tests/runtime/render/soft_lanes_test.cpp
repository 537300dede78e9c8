// The vectors of eight that the `soft` renderer is made of, as they are for any processor; that
// those for AVX2 give the same images is tested with the batch (soft_batch_test.cpp).
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "render/raster/pane_task.h"
#include "support/render_images.h"
// In this order: each builds on those before it.
// clang-format off
#include "render/raster/lanes_eight.inl"
#include "render/raster/sample.inl"
// clang-format on

namespace galactic::render::soft_lanes_test {
namespace {

TEST(SoftLanes, ThoseOfAnySetAreWrittenInTheirOrder) {
  const IntLanes lanes{10, 11, 12, 13, 14, 15, 16, 17};
  for (unsigned which = 0; which < 256; ++which) {
    std::array<std::int32_t, kWidth> written{};
    storePicked(written.data(), lanes, which);
    std::size_t count = 0;
    for (unsigned n = 0; n < kWidth; ++n) {
      if ((which >> n & 1U) == 0) continue;
      ASSERT_EQ(written.at(count++), lanes[n]) << "set " << which;
    }
  }
}

TEST(SoftLanes, NumbersOfRowsBecomeVectors) {
  constexpr std::uint32_t kRow = 16;
  std::array<float, 5 * kRow> rows{};
  for (std::size_t n = 0; n < rows.size(); ++n) rows.at(n) = static_cast<float>(n);
  for (const std::array<std::int32_t, kLanes>& ids :
       {std::array<std::int32_t, kLanes>{3, 3, 3, 3, 3, 3, 3, 3}, {4, 0, 1, 1, 2, 0, 4, 3}}) {
    alignas(kVectorBytes) std::array<std::int32_t, kLanes> starts = ids;
    for (std::int32_t& start : starts) start *= static_cast<std::int32_t>(kRow);
    std::array<Lanes, 8> fields;
    gatherRows(rows.data(), starts.data(), fields.data());
    for (unsigned n = 0; n < kLanes; ++n) {
      const auto row = static_cast<std::size_t>(ids.at(n)) * kRow;
      for (std::size_t field = 0; field < 8; ++field) {
        EXPECT_EQ(fields.at(field)[n], rows.at(row + field)) << "lane " << n;
      }
    }
  }
}

TEST(SoftLanes, VectorsBecomeRows) {
  constexpr std::size_t kRow = 9;
  std::array<Lanes, 8> fields;
  for (unsigned n = 0; n < 8; ++n) {
    fields.at(n) = spread(10.0F * static_cast<float>(n)) + Lanes{0, 1, 2, 3, 4, 5, 6, 7};
  }
  std::array<float, kLanes * kRow> rows{};
  storeTransposed(fields.data(), rows.data(), kRow);
  for (unsigned lane = 0; lane < kLanes; ++lane) {
    for (unsigned field = 0; field < 8; ++field) {
      EXPECT_EQ(rows.at(lane * kRow + field), fields.at(field)[lane]);
    }
  }
}

TEST(SoftLanes, SetsAndExtremesAreThoseOfTheLanes) {
  const IntLanes lanes{5, -3, 8, 0, 7, -9, 2, 6};
  EXPECT_EQ(least(lanes), -9);
  EXPECT_EQ(most(lanes), 8);
  for (unsigned which = 0; which < 256; ++which) {
    const LaneSet set = setOf(which);
    ASSERT_EQ(bitsOf(set), which);
    const IntLanes picked = pickFrom(set, lanes, spread(100));
    for (unsigned n = 0; n < kLanes; ++n) {
      ASSERT_EQ(picked[n], (which >> n & 1U) != 0 ? lanes[n] : 100) << "set " << which;
    }
  }
}

TEST(SoftLanes, OfASetAreWrittenAndOthersStay) {
  const IntLanes lanes{10, 11, 12, 13, 14, 15, 16, 17};
  for (unsigned which = 0; which < 256; ++which) {
    std::array<std::int32_t, kLanes> written{};
    storeFrom(setOf(which), written.data(), lanes);
    for (unsigned n = 0; n < kLanes; ++n) {
      ASSERT_EQ(written.at(n), (which >> n & 1U) != 0 ? lanes[n] : 0) << "set " << which;
    }
  }
}

TEST(SoftLanes, ASquareHasFourNumbersOfEachRow) {
  constexpr std::size_t kStride = 7;
  std::array<float, 3 * kStride> rows{};
  for (std::size_t n = 0; n < rows.size(); ++n) rows.at(n) = static_cast<float>(n);
  const Lanes square = loadSquare(rows.data() + 2, kStride);
  for (unsigned n = 0; n < kLanes; ++n) {
    EXPECT_EQ(square[n], rows.at(2 + n / 4 * kStride + n % 4)) << "lane " << n;
  }
}

TEST(SoftLanes, DoublesStayWithinTheirLimits) {
  const Doubles clamped = clampTo(Doubles{-1e300, -3, 0.5, 7}, -2, 5);
  EXPECT_EQ(clamped[0], -2);
  EXPECT_EQ(clamped[1], -2);
  EXPECT_EQ(clamped[2], 0.5);
  EXPECT_EQ(clamped[3], 5);
}

TEST(SoftLanes, ProductsOfBytesAreRounded) {
  for (std::int32_t a = 0; a < 256; ++a) {
    for (std::int32_t b = 0; b < 256; ++b) {
      const IntLanes both = as<IntLanes>(byteProducts(as<ShortLanes>(spread(a | (255 - a) << 16)),
                                                      as<ShortLanes>(spread(b | b << 16))));
      const auto rounded = [](std::int32_t product) { return (2 * product + 255) / 510; };
      ASSERT_EQ(both[0], rounded(a * b) | rounded((255 - a) * b) << 16) << a << " * " << b;
    }
  }
}

TEST(SoftLanes, BytesAreBlendedInSharesOf256) {
  for (std::int32_t weight = 0; weight <= 256; ++weight) {
    const ShortLanes weights = blendWeight(spread(static_cast<float>(weight) / 256));
    for (std::int32_t p = 0; p < 256; p += 5) {
      for (std::int32_t q = 0; q < 256; q += 3) {
        const IntLanes blended = as<IntLanes>(blend(as<ShortLanes>(spread(p | q << 16)),
                                                    as<ShortLanes>(spread(q | p << 16)), weights));
        const auto rounded = [&](std::int32_t from, std::int32_t to) {
          return (from * (256 - weight) + to * weight + 128) / 256;
        };
        ASSERT_EQ(blended[7], rounded(p, q) | rounded(q, p) << 16)
            << p << " to " << q << ", " << weight;
      }
    }
  }
}

TEST(SoftLanes, NumbersAreRoundedDown) {
  const Whole whole = roundedDown(Lanes{-4194304, -2.5F, -2, -0.25F, 0, 0.75F, 7, 4194303.5F});
  const IntLanes expected{-4194304, -3, -2, -1, 0, 0, 7, 4194303};
  EXPECT_EQ(signBits(whole.whole == expected), kAllLanes);
  EXPECT_EQ(signBits(whole.value == toFloat(expected)), kAllLanes);
}

/// A texture of random texels with all its levels, and a record that shows it.
class SoftSampling : public testing::Test {
 protected:
  static constexpr std::uint32_t kSeed = 20;
  static constexpr std::uint32_t kLogEdge = 6;

  SoftSampling() : texels_(kTexelsBefore + 2 * (1U << (2 * kLogEdge))) {
    for (std::uint32_t& texel : texels_) texel = static_cast<std::uint32_t>(random_());
    base_ = texels_.data();
    task_.texel_bases = &base_;
  }

  /// A surface at random slants, with about 2^-2 to 2^5 texels a pixel.
  void randomRecord() {
    const float rate = std::exp2(test::uniform(random_, -2, 3));
    for (const std::uint32_t field : {kURight, kUDown, kVRight, kVDown}) {
      record_.at(field) = test::uniform(random_, -rate, rate);
    }
    record_[kUStart] = test::uniform(random_, -9, 9);
    record_[kVStart] = test::uniform(random_, -9, 9);
    record_[kWRight] = test::uniform(random_, 0, 0.15F);
    record_[kWDown] = test::uniform(random_, 0, 0.15F);
    record_[kTexels] = as<float>(kTexelsBefore);
    record_[kKind] = as<float>(kLogEdge);
  }

  PixelLanes randomPixels() {
    const Lanes x = spread(test::uniform(random_, 0, 6)) + Lanes{0, 1, 2, 3, 0, 1, 2, 3};
    const Lanes y = spread(test::uniform(random_, 0, 6)) + Lanes{0, 0, 0, 0, 1, 1, 1, 1};
    return {
        x, y,
        spread(1.0F) / (spread(0.4F) + spread(record_[kWRight]) * x + spread(record_[kWDown]) * y)};
  }

  static constexpr std::uint32_t kTexelsBefore = 5;
  std::mt19937 random_{kSeed};
  std::vector<std::uint32_t> texels_;
  const std::uint32_t* base_ = nullptr;
  PaneTask task_;
  std::array<float, kRecordStride> record_{};
};

TEST_F(SoftSampling, OfOneRecordGivesTheBitsThatManyGive) {
  constexpr int kRounds = 4000;
  int levels_differ = 0;
  for (int round = 0; round < kRounds; ++round) {
    randomRecord();
    const PixelLanes pixels = randomPixels();
    const OneRecord record{record_.data()};
    const TexturePlaces places = texturePlaces(record, pixels);
    const IntLanes level =
        levelOf(places.squared_rate, spread(static_cast<std::int32_t>(kLogEdge)));
    levels_differ += signBits(level == spread(level[0])) != kAllLanes ? 1 : 0;
    const IntLanes one = sampleOne(task_, record, pixels);
    ASSERT_EQ(signBits(one == sampleTexels(task_, places)), kAllLanes) << "round " << round;
  }
  EXPECT_GT(levels_differ, kRounds / 10);
  EXPECT_LT(levels_differ, kRounds * 9 / 10);
}

TEST_F(SoftSampling, OfAFlatSurfaceIsItsColor) {
  record_[kTexels] = as<float>(0x12345678);
  record_[kKind] = as<float>(kFlatSurface);
  const IntLanes colors = sampleOne(task_, OneRecord{record_.data()}, randomPixels());
  EXPECT_EQ(signBits(colors == spread(0x12345678)), kAllLanes);
}

}  // namespace
}  // namespace galactic::render::soft_lanes_test
