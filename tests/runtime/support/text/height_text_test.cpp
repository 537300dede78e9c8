#include "support/text/height_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "galactic/simulation_options.h"

namespace galactic::height_text_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr Span kWithin{0, 100};

TEST(HeightText, TakesHeightsAndRanges) {
  EXPECT_THAT(heightsFrom("0.25", kWithin).value(), ElementsAre(Span{0.25F, 0.25F}));
  EXPECT_THAT(heightsFrom("0.25,0.4-0.75,1e-3", kWithin).value(),
              ElementsAre(Span{0.25F, 0.25F}, Span{0.4F, 0.75F}, Span{1e-3F, 1e-3F}));
  EXPECT_THAT(heightsFrom("1e-3-1e+1", kWithin).value(), ElementsAre(Span{1e-3F, 10}));
  EXPECT_THAT(heightsFrom("robot", kWithin).value(), ElementsAre());
}

TEST(HeightText, ReadsBackWhatItWrote) {
  const std::vector<Span> heights{{0.1F / 3, 0.1F / 3}, {1e-7F, 1e-6F}, {0, 0}, {99, 100}};
  EXPECT_EQ(heightText(heights), "0.033333335,1e-07-1e-06,0,99-100");
  EXPECT_EQ(heightsFrom(heightText(heights), kWithin), heights);
  EXPECT_EQ(heightText({}), "robot");
}

TEST(HeightText, RefusesEverythingElse) {
  for (const char* text : {"",      ",",   "1,",    ",1",    "1-",      "-1",      "1-2-3", "1--2",
                           "1 ",    " 1",  "1, 2",  "1;2",   "2-1",     "101",     "1-101", "nan",
                           "0-nan", "inf", "0-inf", "1e999", "robot,1", "1,robot", "Robot", "+1"}) {
    EXPECT_FALSE(heightsFrom(text, kWithin)) << text;
  }
  std::string most = "1";
  for (std::size_t n = 1; n < kMostLaserHeights; ++n) most += ",1";
  EXPECT_TRUE(heightsFrom(most, kWithin));
  EXPECT_FALSE(heightsFrom(most + ",1", kWithin));
  EXPECT_THAT(wantedHeights(kWithin), HasSubstr("up to 16 heights from 0 to 100"));
}

}  // namespace
}  // namespace galactic::height_text_test
