#include "pack_tool/pictures/pictures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "pack_tool/pictures/axes.h"
#include "pictures/font.h"
#include "pictures/palette.h"
#include "pictures/png_file.h"
#include "support/file_content.h"
#include "support/pack_tool_fixture.h"
#include "support/program_run.h"

namespace galactic::pictures::pictures_test {
namespace {

using test::GridBuilder;
using test::GridSpec;
using testing::ElementsAre;
using testing::HasSubstr;

/// Color in the middle of a cell of a plan.
Rgb cellColor(const Picture& picture, const ColumnGrid& grid, ColumnIndex cell) {
  const PixelRect& plot = picture.plots.front();
  const auto middle = [](int first, int length, std::uint32_t index, std::uint32_t count) {
    return first + static_cast<int>((index + 0.5) * length / count);
  };
  return picture.image.at(middle(plot.x, plot.width, cell.i, grid.columnsX()),
                          middle(plot.y, plot.height, cell.k, grid.columnsZ()));
}

test::TestGrid fourKinds() {
  return GridBuilder(GridSpec{})
      .column(0, 0, {{0, 8}})
      .column(1, 0, {{1, 2}, {3, 6}})
      .column(4, 2, {{1, 3}})
      .column(2, 1, {{1, 2}, {3, 4}, {5, 7}})
      .build();
}

TEST(PlanPicture, ColorsEachCellByItsTotalFreeHeight) {
  const auto grid = fourKinds();
  const Picture picture = drawPlan(std::vector{grid.view()}, {});
  EXPECT_EQ(cellColor(picture, grid.view(), {0, 0}), scaleColor(1));
  EXPECT_EQ(cellColor(picture, grid.view(), {1, 0}), scaleColor(0.5));
  EXPECT_EQ(cellColor(picture, grid.view(), {2, 1}), scaleColor(0.5));
  EXPECT_EQ(cellColor(picture, grid.view(), {4, 2}), scaleColor(0.25));
  EXPECT_EQ(cellColor(picture, grid.view(), {3, 2}), kBlocked);
}

TEST(PlanPicture, ColorsByTheLowestSpanOrTheNumberOfSpans) {
  const auto grid = fourKinds();
  const Picture lowest = drawPlan(std::vector{grid.view()}, {.value = PlanValue::kLowestHeight});
  EXPECT_EQ(cellColor(lowest, grid.view(), {0, 0}), scaleColor(1));
  EXPECT_EQ(cellColor(lowest, grid.view(), {1, 0}), scaleColor(1.0 / 8));
  const Picture count = drawPlan(std::vector{grid.view()}, {.value = PlanValue::kSpanCount});
  EXPECT_EQ(cellColor(count, grid.view(), {2, 1}), scaleColor(1));
  EXPECT_EQ(cellColor(count, grid.view(), {4, 2}), scaleColor(1.0 / 3));
}

/// A scene that is open to the outside: the grid begins below its floor.
TEST(PlanPicture, DoesNotTakeWhatLiesUnderTheFloorForTheLowestSpan) {
  GridSpec spec;
  const float edge = GridBuilder(spec).build().view().heights().lo;
  const auto grid = GridBuilder(spec)
                        .column(0, 0, {{edge, edge + 0.5F}, {edge + 1, edge + 5}})
                        .column(1, 0, {{edge, edge + 2}})
                        .column(2, 0, {{edge + 0.5F, edge + 1.5F}, {edge + 2, edge + 5}})
                        .build();
  const Picture lowest = drawPlan(std::vector{grid.view()}, {.value = PlanValue::kLowestHeight});
  EXPECT_EQ(cellColor(lowest, grid.view(), {0, 0}), scaleColor(1));
  EXPECT_EQ(cellColor(lowest, grid.view(), {1, 0}), scaleColor(0.5)) << "there is no other";
  EXPECT_EQ(cellColor(lowest, grid.view(), {2, 0}), scaleColor(0.25));
}

TEST(PlanPicture, GivesEachCellAWholeNumberOfPixels) {
  const auto grid =
      GridBuilder(GridSpec{.spacing = 0.03125F, .columns_x = 250, .columns_z = 400}).build();
  const Picture picture = drawPlan(std::vector{grid.view()}, {});
  EXPECT_EQ(picture.plots.front().width, 1000);
  EXPECT_EQ(picture.plots.front().height, 1600);
}

TEST(PlanPicture, ShrinksGridsLargerThanThePicture) {
  const auto grid = GridBuilder(GridSpec{.spacing = 0.03125F, .columns_x = 3000, .columns_z = 10})
                        .column(2999, 9, {{1, 2}})
                        .build();
  const Picture picture = drawPlan(std::vector{grid.view()}, {});
  EXPECT_LE(picture.plots.front().width, 1000);
  EXPECT_GE(picture.plots.front().height, 1);
}

/// Free everywhere but for a wall one column thick with a door.
test::TestGrid longHall(std::uint32_t columns, std::uint32_t wall, std::uint32_t door) {
  GridBuilder builder(GridSpec{.spacing = 0.03125F, .columns_x = columns, .columns_z = 90});
  for (std::uint32_t k = 0; k < 90; ++k) {
    for (std::uint32_t i = 0; i < columns; ++i) {
      const bool is_wall = i == wall && (k < door || k >= door + 27);
      if (!is_wall) builder.column(i, k, {{0, i < wall ? 2.0F : 1.0F}});
    }
  }
  return builder.build();
}

TEST(PlanPicture, KeepsWallsAndDoorsOfGridsLargerThanThePicture) {
  constexpr std::uint32_t kDoor = 30;
  for (const std::uint32_t wall : {1U, 700U, 1000U, 1397U}) {
    const auto grid = longHall(1400, wall, kDoor);
    const auto second = longHall(1400, wall + 1, kDoor);
    for (const auto& picture : {drawPlan(std::vector{grid.view()}, {}),
                                drawPlan(std::vector{grid.view(), second.view()}, {}),
                                drawPlan(std::vector{grid.view()}, {.width = 128})}) {
      const PixelRect& plot = picture.plots.front();
      for (unsigned y = 0; y < static_cast<unsigned>(plot.height); ++y) {
        int blocked = 0;
        for (int x = 0; x < plot.width; ++x) {
          blocked += picture.image.at(plot.x + x, plot.y + static_cast<int>(y)) == kBlocked ? 1 : 0;
        }
        // Rows of pixels that show a part of the wall beside the door are blocked.
        const std::uint32_t first = y * 90U / static_cast<unsigned>(plot.height);
        const std::uint32_t end =
            std::max(first + 1, (y + 1) * 90U / static_cast<unsigned>(plot.height));
        const bool is_door = first >= kDoor && end <= kDoor + 27;
        EXPECT_EQ(blocked, is_door ? 0 : 1) << "wall " << wall << ", row " << y;
      }
    }
  }
}

TEST(PlanPicture, IsAboutAsWideAsAskedFor) {
  const auto grid = longHall(1400, 700, 30);
  for (const int width : {64, 700, 1400, 2800, kLargestPlot}) {
    const Picture picture = drawPlan(std::vector{grid.view()}, {.width = width});
    EXPECT_NEAR(picture.plots.front().width, width, width / 2.0);
    EXPECT_GE(picture.image.width(), picture.plots.front().right());
  }
}

TEST(PlanPicture, PutsSeveralGridsSideBySideOnOneScale) {
  const auto low = GridBuilder(GridSpec{}).column(0, 0, {{1, 3}}).build();
  const auto high = GridBuilder(GridSpec{.radius = 0.75F}).column(0, 0, {{1, 5}}).build();
  const Picture picture = drawPlan(std::vector{low.view(), high.view()}, {.title = "kitchen"});
  ASSERT_EQ(picture.plots.size(), 2U);
  EXPECT_LT(picture.plots[0].right(), picture.plots[1].x);
  EXPECT_LT(picture.plots[1].right(), picture.image.width());
  EXPECT_EQ(picture.plots[0].y, picture.plots[1].y);
  EXPECT_EQ(picture.image.at(picture.plots[0].x, picture.plots[0].y), scaleColor(0.5));
  EXPECT_EQ(picture.image.at(picture.plots[1].x, picture.plots[1].y), scaleColor(1));
}

TEST(PlanPicture, DrawsAGridWithoutFreeSpace) {
  const auto grid = GridBuilder(GridSpec{}).build();
  const Picture picture = drawPlan(std::vector{grid.view()}, {});
  EXPECT_EQ(cellColor(picture, grid.view(), {0, 0}), kBlocked);
}

/// Color of a slice at a distance along its line and a height, meters.
Rgb sliceColor(const Picture& picture, double along_share, double height_share) {
  const PixelRect& plot = picture.plots.front();
  return picture.image.at(plot.x + static_cast<int>(along_share * plot.width),
                          plot.bottom() - 1 - static_cast<int>(height_share * plot.height));
}

/// Heights 0 to 8 in the third row: free up to 3.1 m in cell 0, blocked in cell 1, a tall column in
/// cell 2.
test::TestGrid sliceGrid() {
  return GridBuilder(GridSpec{})
      .column(0, 2, {{0, 3.1F}})
      .column(2, 2, {{0, 1.1F}, {2.1F, 3.1F}, {6.1F, 7.9F}})
      .build();
}

TEST(SlicePicture, ShowsFreeHeightsLightAndBlockedOnesDark) {
  const auto grid = sliceGrid();
  const auto picture = drawSlice(std::vector{grid.view()}, {.from = {0, 2.5}, .to = {5, 2.5}});
  ASSERT_TRUE(picture) << picture.error().message;
  const auto at = [&](double x, double y) { return sliceColor(*picture, x / 5, y / 8); };
  EXPECT_EQ(at(0.5, 0.3), kFree);
  EXPECT_EQ(at(0.5, 2.8), kFree);
  EXPECT_EQ(at(0.5, 3.3), kBlocked);
  EXPECT_EQ(at(1.5, 0.3), kBlocked);
  EXPECT_EQ(at(2.5, 0.8), kFree);
  EXPECT_EQ(at(2.5, 1.8), kBlocked);
  EXPECT_EQ(at(2.5, 2.8), kFree);
  EXPECT_EQ(at(2.5, 7.7), kFree);
}

TEST(SlicePicture, MarksWhatTheGridDoesNotCover) {
  const auto grid = sliceGrid();
  const auto picture = drawSlice(std::vector{grid.view()}, {.from = {-5, 2.5}, .to = {5, 2.5}});
  ASSERT_TRUE(picture) << picture.error().message;
  EXPECT_EQ(sliceColor(*picture, 0.25, 0.8), kUncovered);
  EXPECT_EQ(sliceColor(*picture, 0.55, 0.3), kFree);
}

TEST(SlicePicture, ShowsOnlyWhatIsOverTheGridOfALineThatGoesFarBeyond) {
  const auto grid = sliceGrid();
  const ColumnGrid view = grid.view();
  const double end = view.layout().columns_x * static_cast<double>(view.layout().spacing);
  const auto wanted = drawSlice(std::vector{grid.view()}, {.from = {0, 2.5}, .to = {end, 2.5}});
  ASSERT_TRUE(wanted);
  for (const double far : {300.0, 1e4, 1e9}) {
    const auto picture =
        drawSlice(std::vector{grid.view()}, {.from = {-far, 2.5}, .to = {far + 0.3, 2.5}});
    ASSERT_TRUE(picture) << far << ": " << picture.error().message;
    for (double x = 0.25; x < end; x += 0.5) {
      for (double y = 0.3; y < 8; y += 0.5) {
        EXPECT_EQ(sliceColor(*picture, x / end, y / 8), sliceColor(*wanted, x / end, y / 8))
            << far << ", at " << x << ", " << y;
      }
    }
  }
}

TEST(SlicePicture, OfALineAcrossACornerHasItsColumn) {
  const auto grid = sliceGrid();
  // Crosses 2 cm of cell (0, 0), far from the middle of any of 1000 parts of the line.
  const auto picture =
      drawSlice(std::vector{grid.view()}, {.from = {-1000, 1000.015}, .to = {1000, -999.985}});
  ASSERT_TRUE(picture) << picture.error().message;
  EXPECT_EQ(sliceColor(*picture, 0.5, 0.5), kBlocked);
  const auto past =
      drawSlice(std::vector{grid.view()}, {.from = {-1000, 999.985}, .to = {1000, -1000.015}});
  EXPECT_FALSE(past);
}

TEST(SlicePicture, IsAsWideAsAskedForButNoHigherThanThat) {
  const auto grid = sliceGrid();
  for (const auto& [width, wanted] :
       {std::pair{300, PixelRect{0, 0, 300, 480}}, {kLargestPlot, {0, 0, 2560, kLargestPlot}}}) {
    const auto picture =
        drawSlice(std::vector{grid.view()}, {.from = {0, 2.5}, .to = {5, 2.5}, .width = width});
    ASSERT_TRUE(picture) << picture.error().message;
    // Five meters wide and eight high.
    EXPECT_EQ(picture->plots.front().width, wanted.width);
    EXPECT_EQ(picture->plots.front().height, wanted.height);
  }
}

TEST(SlicePicture, RefusesALineThatIsTooShortOrMissesTheGrid) {
  const auto grid = sliceGrid();
  const auto point = drawSlice(std::vector{grid.view()}, {.from = {1, 1}, .to = {1, 1}});
  ASSERT_FALSE(point);
  EXPECT_EQ(point.error().code, ErrorCode::kInvalidInput);
  EXPECT_THAT(point.error().message, HasSubstr("at least a cell (1 m) apart"));
  const auto far = drawSlice(std::vector{grid.view()}, {.from = {10, 10}, .to = {20, 10}});
  ASSERT_FALSE(far);
  EXPECT_THAT(far.error().message, HasSubstr("misses the grid"));
  const double nan = std::nan("");
  EXPECT_FALSE(drawSlice(std::vector{grid.view()}, {.from = {nan, 0}, .to = {1, 1}}));
}

TEST(ScaleColor, RunsFromVioletToYellowAndClamps) {
  EXPECT_EQ(scaleColor(0), (Rgb{0x44, 0x01, 0x54}));
  EXPECT_EQ(scaleColor(1), (Rgb{0xfd, 0xe7, 0x25}));
  EXPECT_EQ(scaleColor(-3), scaleColor(0));
  EXPECT_EQ(scaleColor(7), scaleColor(1));
  EXPECT_EQ(scaleColor(std::nan("")), scaleColor(0));
}

TEST(ScaleColor, GrowsBrighterAllTheWay) {
  const auto brightness = [](Rgb color) {
    return 0.2126 * color.r + 0.7152 * color.g + 0.0722 * color.b;
  };
  for (int n = 0; n < 100; ++n) {
    EXPECT_LE(brightness(scaleColor(n / 100.0)), brightness(scaleColor((n + 1) / 100.0)) + 1);
  }
}

TEST(Axes, PutTicksAtRoundValues) {
  std::vector<std::string> labels;
  for (const Tick& tick : axisTicks({-0.61, 1.3, 0, 382}, 70)) labels.push_back(tick.label);
  EXPECT_THAT(labels, ElementsAre("-0.5", "0.0", "0.5", "1.0"));
  EXPECT_TRUE(axisTicks({1, 1, 0, 100}, 70).empty());
}

TEST(Axes, RoundDownToOneTwoOrFive) {
  EXPECT_DOUBLE_EQ(roundDown(0.19), 0.1);
  EXPECT_DOUBLE_EQ(roundDown(0.2), 0.2);
  EXPECT_DOUBLE_EQ(roundDown(4.9), 2);
  EXPECT_DOUBLE_EQ(roundDown(50), 50);
}

TEST(DrawText, DrawsTheGlyphsPixelsAndNothingOutsideTheImage) {
  Image image(40, 20, kPaper);
  drawText(image, {1, 1}, "I", kInk);
  // The top bar of the capital I: pixels 1 to 3 of 5.
  EXPECT_EQ(image.at(1, 1), kPaper);
  EXPECT_EQ(image.at(1 + kTextScale, 1), kInk);
  EXPECT_EQ(image.at(1 + 4 * kTextScale, 1), kPaper);
  drawText(image, {-30, -5}, "outside \xc3\xbc text that is much too long", kInk);
  EXPECT_EQ(glyphOf('\x01'), glyphOf('?'));
}

TEST(DrawText, WritesLatinLettersWithTheirBaseLetters) {
  EXPECT_EQ(lettering("plain ASCII ~"), "plain ASCII ~");
  EXPECT_EQ(lettering("K\u00fcche, Caf\u00e9, \u00c5, \u00ff"), "Kuche, Cafe, A, y");
  EXPECT_EQ(lettering("Stra\u00dfe, \u00c6, \u00f8"), "Strasse, AE, o");
  EXPECT_EQ(lettering("\u53f0\u6240, \u0161, \U0001f600, 2 \u00b5m, \u00f7"), "??, ?, ?, 2 ?m, ?");
  // Not UTF-8.
  EXPECT_EQ(lettering("a\xc3"), "a");
  EXPECT_EQ(lettering("\xc3(\xbc\xff"), "(?");
  EXPECT_EQ(textWidth("\u00fc"), textWidth("u"));
  EXPECT_EQ(textWidth("\u00df"), textWidth("ss"));
  Image letter(40, 20, kPaper);
  Image base(40, 20, kPaper);
  drawText(letter, {1, 1}, "\u00df", kInk);
  drawText(base, {1, 1}, "ss", kInk);
  EXPECT_EQ(letter.pixels(), base.pixels());
}

TEST(WritePng, WritesASignedFileOfTheImagesSizeAndTheSameBytesAgain) {
  const test::ScratchFolder folder;
  const Image image(3, 2, kInk);
  ASSERT_TRUE(writePng(folder.path() / "a.png", image));
  ASSERT_TRUE(writePng(folder.path() / "b.png", image));
  const std::string bytes = test::fileContent(folder.path() / "a.png");
  EXPECT_EQ(bytes, test::fileContent(folder.path() / "b.png"));
  EXPECT_EQ(bytes.substr(0, 8), "\x89PNG\r\n\x1a\n");
  EXPECT_EQ(bytes.substr(16, 8), std::string("\0\0\0\3\0\0\0\2", 8));
  EXPECT_EQ(test::countEntries(folder.path()), 2U);
}

TEST(WritePng, WritesSixteenBitsOfGray) {
  const test::ScratchFolder folder;
  ASSERT_TRUE(writePng(folder.path() / "deep.png", DeepImage{2, 1, {0x1234, 65535}}));
  const std::string bytes = test::fileContent(folder.path() / "deep.png");
  EXPECT_EQ(bytes.substr(16, 8), std::string("\0\0\0\2\0\0\0\1", 8));
  // Bits of a sample, and gray.
  EXPECT_EQ(bytes.substr(24, 2), std::string("\x10\0", 2));
}

}  // namespace
}  // namespace galactic::pictures::pictures_test
