// Sheets of many pictures: their cells and captions, and which moments of a run they show.
#include "drawing/contact_sheet.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "drawing/sheet_moments.h"
#include "pictures/drawing.h"
#include "pictures/palette.h"

namespace galactic::contact_sheet_test {
namespace {

using pictures::Image;
using testing::ElementsAre;

TEST(ContactSheet, PutsCellsInRowsWithTheirCaptionsBelow) {
  const Image red(3, 2, {255, 0, 0});
  const Image blue(3, 2, {0, 0, 255});
  const Image sheet = contactSheet({{red, "I"}, {blue, ""}, {red, ""}}, 2);
  // A letter is wider than the pictures: 5 x 7 font pixels.
  const int width = pictures::textWidth("I") + kCaptionGap - kSheetGap;
  const int height = 2 + kSheetGap + pictures::kTextHeight;
  EXPECT_EQ(sheet.width(), 3 * kSheetGap + 2 * width);
  EXPECT_EQ(sheet.height(), 3 * kSheetGap + 2 * height);
  const int left = 2 * kSheetGap + width;
  const int top = 2 * kSheetGap + height;
  EXPECT_EQ(sheet.at(kSheetGap, kSheetGap), red.at(0, 0));
  EXPECT_EQ(sheet.at(kSheetGap + 2, kSheetGap + 1), red.at(0, 0));
  EXPECT_EQ(sheet.at(kSheetGap + 3, kSheetGap), pictures::kPaper);
  EXPECT_EQ(sheet.at(kSheetGap, kSheetGap + 2), pictures::kPaper);
  EXPECT_EQ(sheet.at(left, kSheetGap), blue.at(0, 0));
  EXPECT_EQ(sheet.at(kSheetGap, top), red.at(0, 0));
  EXPECT_EQ(sheet.at(left, top), pictures::kPaper);
  // The top bar of the letter.
  EXPECT_EQ(sheet.at(kSheetGap + pictures::kTextScale, kSheetGap + 2 + kSheetGap / 2),
            pictures::kInk);
}

TEST(ContactSheet, BreaksCaptionsThatAreWiderThanTheirPictures) {
  constexpr int kWidth = 128;
  const Image grey(kWidth, 4, {90, 90, 90});
  const auto sheet_of = [&grey](const std::string& caption) {
    return contactSheet({{grey, caption}, {grey, caption}}, 2);
  };
  const Image one_line = sheet_of("env 0");
  EXPECT_EQ(one_line.width(), 3 * kSheetGap + 2 * kWidth);
  EXPECT_EQ(one_line.height(), 3 * kSheetGap + 4 + pictures::kTextHeight);
  ASSERT_GT(pictures::textWidth("env 0, step 0"), kWidth);
  const Image two_lines = sheet_of("env 0, step 0");
  EXPECT_EQ(two_lines.width(), one_line.width());
  EXPECT_EQ(two_lines.height(), one_line.height() + kCaptionAdvance);
  // Both lines have ink, and between the captions there is none.
  const auto inked = [](const Image& sheet, const pictures::PixelRect& part) {
    for (int y = part.y; y < part.bottom(); ++y) {
      for (int x = part.x; x < part.right(); ++x) {
        if (sheet.at(x, y) == pictures::kInk) return true;
      }
    }
    return false;
  };
  const int first = kSheetGap + 4 + kSheetGap / 2;
  EXPECT_TRUE(inked(two_lines, {kSheetGap, first, kWidth, pictures::kTextHeight}));
  EXPECT_TRUE(
      inked(two_lines, {kSheetGap, first + kCaptionAdvance, kWidth, pictures::kTextHeight}));
  // As many as it takes; a phrase is not broken.
  EXPECT_EQ(sheet_of("env 0, step 0, a cup, the fork").height(),
            one_line.height() + 3 * kCaptionAdvance);
  EXPECT_EQ(sheet_of("a, b, c, d, e").height(), one_line.height() + kCaptionAdvance);
  // A word that is wider yet makes the cells wider, and leaves a gap.
  const std::string word(12, 'W');
  const Image wide = sheet_of(word);
  const int right_of_word = kSheetGap + pictures::textWidth(word);
  EXPECT_EQ(wide.height(), one_line.height());
  EXPECT_TRUE(inked(wide, {right_of_word - 2, 0, 2, wide.height()}));
  EXPECT_FALSE(inked(wide, {right_of_word, 0, kCaptionGap, wide.height()}));
  EXPECT_TRUE(inked(wide, {right_of_word + kCaptionGap, 0, 2, wide.height()}));
}

TEST(ContactSheet, HasHeadingsAboveItsColumnsAndALegendBelow) {
  const pictures::Rgb green{0, 200, 0};
  const Image grey(64, 4, {90, 90, 90});
  const std::vector<SheetCell> cells{{grey, "a"}, {grey, "b"}, {grey, "c"}, {grey, "d"}};
  const Image plain = contactSheet(cells, 2);
  SheetGuide guide{.headings = {{0, "II"}, {32, "I"}}, .legend = {{{green, "yes"}, {{}, "no"}}}};
  const Image sheet = contactSheet(cells, 2, guide);
  const int above = kSheetGap + pictures::kTextHeight;
  EXPECT_EQ(sheet.width(), plain.width());
  EXPECT_EQ(sheet.height(), plain.height() + above + kSheetGap + kCaptionAdvance);
  // The bars of the letters of each heading, over both columns.
  for (const int column : {0, 1}) {
    const int left = kSheetGap + column * (64 + kSheetGap);
    for (const int x : {left, left + pictures::kTextAdvance, left + 32}) {
      EXPECT_EQ(sheet.at(x + 2 * pictures::kTextScale, kSheetGap), pictures::kInk) << x;
    }
  }
  // What was there is below the headings.
  for (int y = kSheetGap; y < plain.height(); ++y) {
    for (int x = 0; x < plain.width(); ++x) ASSERT_EQ(sheet.at(x, y + above), plain.at(x, y));
  }
  const int legend = plain.height() + above;
  EXPECT_EQ(sheet.at(kSheetGap + 4, legend + 4), green);
  // An entry that does not fit goes to the next line, and what fits on none makes the sheet wider.
  guide.legend[0].push_back({{}, "perhaps"});
  EXPECT_EQ(contactSheet(cells, 2, guide).height(), sheet.height() + kCaptionAdvance);
  const std::string wide(20, 'W');
  guide.legend.push_back({{{}, wide}});
  EXPECT_EQ(contactSheet(cells, 2, guide).width(), pictures::textWidth(wide) + 2 * kSheetGap);
}

/// The steps that a sheet shows of a run of `planned` steps that ends after `done`.
std::vector<std::uint64_t> stepsOnSheet(std::uint64_t planned, std::uint64_t done,
                                        std::uint64_t every = 1) {
  SheetMoments sheet(planned, every);
  std::size_t held = 0;
  for (std::uint64_t step = 0; step <= done; ++step) {
    if (step != done && !sheet.wants(step)) continue;
    sheet.add({step, {{Image(1, 1, {}), "env 0"}}});
    ++held;
  }
  EXPECT_LT(held, 200U) << "few states are copied";
  std::vector<std::uint64_t> steps;
  for (const SheetMoments::Moment& moment : sheet.take()) {
    EXPECT_EQ(moment.cells.size(), 1U);
    steps.push_back(moment.step);
  }
  return steps;
}

TEST(SheetMoments, AreThePlannedOnesOfARunThatDoesAllItsSteps) {
  EXPECT_THAT(stepsOnSheet(1000, 1000), ElementsAre(0, 200, 400, 600, 800, 1000));
  EXPECT_THAT(stepsOnSheet(3, 3), ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(stepsOnSheet(1, 1), ElementsAre(0, 1));
  // The last state is shown wherever the run ends.
  EXPECT_THAT(stepsOnSheet(20, 20, 8), ElementsAre(0, 8, 16, 20));
  EXPECT_THAT(stepsOnSheet(5, 5, 100), ElementsAre(0, 5));
}

TEST(SheetMoments, AreEvenlySpreadWhereverARunEnds) {
  for (const std::uint64_t planned : {1000U, 5000U, 1000000000U}) {
    for (const std::uint64_t done : {0U, 4U, 5U, 13U, 24U, 25U, 41U, 369U, 370U, 999U}) {
      SCOPED_TRACE(std::to_string(done) + " of " + std::to_string(planned));
      const std::vector<std::uint64_t> steps = stepsOnSheet(planned, done);
      ASSERT_EQ(steps.size(), std::min<std::uint64_t>(done + 1, SheetMoments::kMost));
      EXPECT_EQ(steps.front(), 0U);
      EXPECT_EQ(steps.back(), done);
      // A moment is held at least each twelfth part of the run.
      for (std::size_t row = 1; row < steps.size(); ++row) {
        const double wanted = static_cast<double>(row * done) / 5;
        const double off = static_cast<double>(steps[row]) - wanted;
        EXPECT_LT(steps[row - 1], steps[row]);
        if (done < 5) continue;
        EXPECT_LE(std::abs(off), static_cast<double>(done) / 24 + 0.5);
      }
    }
  }
}

}  // namespace
}  // namespace galactic::contact_sheet_test
