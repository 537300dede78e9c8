#include "support/text/range_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace galactic::range_text_test {
namespace {

constexpr Span kShare{0, 1};
/// Below 0: something else.
constexpr Span kOrElse{-1, 10};

TEST(RangeText, TakesNumbersAndRanges) {
  EXPECT_EQ(drawnFrom("0.25", kShare), DrawnNumber(0.25F));
  EXPECT_EQ(drawnFrom("0.25-0.5", kShare), DrawnNumber(0.25F, 0.5F));
  EXPECT_EQ(drawnFrom("1e-3-1e-1", kShare), DrawnNumber(1e-3F, 0.1F));
  EXPECT_EQ(drawnFrom("0-1", kShare), DrawnNumber(0, 1));
  EXPECT_EQ(drawnFrom("0.5-0.5", kShare), DrawnNumber(0.5F));
  EXPECT_EQ(drawnFrom("-1", kOrElse), DrawnNumber(-1));
  EXPECT_EQ(drawnFrom("0-10", kOrElse), DrawnNumber(0, 10));
}

TEST(RangeText, ReadsBackWhatItWrote) {
  for (const DrawnNumber& number : {DrawnNumber(0.1F / 3), DrawnNumber(1e-7F, 0.1F / 7),
                                    DrawnNumber(0), DrawnNumber(0.5F, 1)}) {
    EXPECT_EQ(drawnFrom(drawnText(number), kShare), number);
  }
  EXPECT_EQ(drawnText(DrawnNumber{0.25F, 0.5F}), "0.25-0.5");
  EXPECT_EQ(drawnText(DrawnNumber(-1)), "-1");
}

TEST(RangeText, RefusesEverythingElse) {
  for (const char* text :
       {"",         "-",   "0.1-",     "-0.1",  "0.5-0.2", "0.1--0.2", "0.1-0.2-0.3", "0.1..0.2",
        "0.1 -0.2", " 1",  "0.1-0.2 ", "1.5",   "0.5-1.5", "nan",      "0-nan",       "nan-1",
        "nan-nan",  "inf", "0-inf",    "1e999", "0.1,0.2", "robot",    "+0.1"}) {
    EXPECT_FALSE(drawnFrom(text, kShare)) << text;
  }
  // A range in which some numbers stand for something else.
  for (const char* text : {"-1-5", "-0.5-0.5", "-2", "-1--0.5"}) {
    EXPECT_FALSE(drawnFrom(text, kOrElse)) << text;
  }
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(isDrawnWithin({kNan, 1}, kShare));
  EXPECT_FALSE(isDrawnWithin({0, kNan}, kShare));
  EXPECT_FALSE(isDrawnWithin(kNan, kShare));
  EXPECT_EQ(wantedDrawn(kOrElse), "-1 to 10, or a range from 0 to 10 such as 0.1-0.3");
}

TEST(RangeText, TakesWholeNumbersAndRangesOfThem) {
  constexpr std::uint32_t kMost = 100;
  EXPECT_EQ(drawnFrom("0", kMost), DrawnCount(0));
  EXPECT_EQ(drawnFrom("7", kMost), DrawnCount(7));
  EXPECT_EQ(drawnFrom("0-2", kMost), DrawnCount(0, 2));
  EXPECT_EQ(drawnFrom("100-100", kMost), DrawnCount(100));
  for (const DrawnCount& count : {DrawnCount(3), DrawnCount(0, 100)}) {
    EXPECT_EQ(drawnFrom(drawnText(count), kMost), count);
  }
  for (const char* text :
       {"",      "-",   "-1",  "0-",    "2-0", "0--2",       "0-1-2",        "101",
        "0-101", "0.5", "1.0", "0-1.5", "1e1", "4294967296", "0-4294967298", "nan",
        " 1",    "1 ",  "+1",  "one"}) {
    EXPECT_FALSE(drawnFrom(text, kMost)) << text;
  }
}

TEST(DrawnCount, DrawsEachNumberOfItsRangeAsOften) {
  constexpr DrawnCount kRange{2, 4};
  EXPECT_TRUE(kRange.isRange());
  EXPECT_EQ(kRange.at(0), 2U);
  EXPECT_EQ(kRange.at(0.33F), 2U);
  EXPECT_EQ(kRange.at(0.34F), 3U);
  EXPECT_EQ(kRange.at(0.67F), 4U);
  EXPECT_EQ(kRange.at(1), 4U);
  EXPECT_FALSE(DrawnCount(3).isRange());
  EXPECT_EQ(DrawnCount(3).at(0.9F), 3U);
}

TEST(DrawnNumber, LiesInItsRange) {
  constexpr DrawnNumber kRange{0.1F, 0.7F};
  EXPECT_TRUE(kRange.isRange());
  EXPECT_EQ(kRange.at(0), 0.1F);
  EXPECT_EQ(kRange.at(1), 0.7F);
  EXPECT_FLOAT_EQ(kRange.at(0.5F), 0.4F);
  EXPECT_FALSE(DrawnNumber(0.3F).isRange());
  EXPECT_EQ(DrawnNumber(0.3F).at(0.9F), 0.3F);
}

}  // namespace
}  // namespace galactic::range_text_test
