// Scenes from above with the episodes in them, and where they come from.
#include "pack_tool/pictures/episode_plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "pack_tool/figure/episode_plans.h"
#include "pack_tool/pictures/figure_view.h"
#include "pack_tool/verbs/verbs.h"
#include "support/file_content.h"
#include "support/pack_tool_fixture.h"
#include "support/packs/world_pack_builder.h"
#include "support/program_run.h"

namespace galactic::pictures::episode_plan_test {
namespace {

namespace fs = std::filesystem;
using pack_tool::EpisodeChoice;
using pack_tool::episodePlansOf;
using pack_tool::GroundPoint;
using test::GridBuilder;
using test::GridSpec;
using test::ScratchFolder;
using testing::ElementsAre;
using testing::HasSubstr;

/// A hall of 10 x 6 m, all of it floor.
test::TestGrid hall() {
  GridBuilder builder(GridSpec{.columns_x = 10, .columns_z = 6});
  for (std::uint32_t k = 0; k < 6; ++k) {
    for (std::uint32_t i = 0; i < 10; ++i) builder.column(i, k, {{0, 3}});
  }
  return builder.build();
}

EpisodeMarks tidyUp() {
  return {.number = 7,
          .start = {2, 3},
          .yaw = std::numbers::pi / 2,
          .target = {5, 2},
          .goal = {8, 4},
          .others = {{1, 1}}};
}

/// The color at a point of the ground, and some pixels beside it.
Rgb colorAt(const Picture& picture, const GroundPoint& point, int right = 0, int down = 0) {
  const PixelRect& plot = picture.plots.front();
  return picture.image.at(plot.x + static_cast<int>(point.x * plot.width / 10) + right,
                          plot.y + static_cast<int>(point.z * plot.height / 6) + down);
}

TEST(EpisodePlanPicture, MarksStartsTargetsAndGoals) {
  const auto grid = hall();
  const Picture picture = drawEpisodePlan({"hall", grid.view(), {tidyUp()}}, 800);
  EXPECT_EQ(picture.plots.front().width, 800);
  EXPECT_EQ(picture.plots.front().height, 480);
  EXPECT_EQ(colorAt(picture, {2, 3}), kStartMark);
  EXPECT_EQ(colorAt(picture, {5, 2}), kTargetMark);
  EXPECT_EQ(colorAt(picture, {8, 4}), kGoalMark);
  // It looks to -Z: up.
  EXPECT_EQ(colorAt(picture, {2, 3}, 0, -9), kStartMark);
  const Rgb floor = colorAt(picture, {9.5, 5.5});
  EXPECT_EQ(colorAt(picture, {2, 3}, 0, 11), floor);
  EXPECT_EQ(colorAt(picture, {2, 3}, 11, 0), floor);
  // A line joins target and goal.
  EXPECT_NE(colorAt(picture, {6.5, 3}), floor);
}

TEST(EpisodePlanPicture, ShowsWhatIsBlockedAndWhatIsLow) {
  GridBuilder builder(GridSpec{.columns_x = 10, .columns_z = 6});
  builder.column(0, 0, {{0, 3}}).column(1, 0, {{0.125F, 0.5F}, {1, 3}});
  const auto grid = builder.build();
  const Picture picture = drawEpisodePlan({"hall", grid.view(), {}}, 800);
  const auto brightness = [&](double x) { return colorAt(picture, {x, 0.5}).g; };
  EXPECT_GT(brightness(0.5), 240);
  EXPECT_LT(brightness(1.5), 220);
  EXPECT_LT(brightness(2.5), 120);
}

TEST(EpisodePlanPicture, ShowsSolidFurnitureInGrayAndFloorsOfAllLevelsLight) {
  GridBuilder builder(GridSpec{.heights = {-1, 7}, .columns_x = 10, .columns_z = 6});
  for (std::uint32_t k = 0; k < 6; ++k) {
    for (std::uint32_t i = 0; i < 10; ++i) {
      // From x = 7 on, a floor half a meter higher.
      const float floor = i < 7 ? 0 : 0.5F;
      builder.column(i, k, {{floor, 3}});
    }
  }
  builder.column(1, 0, {{0.25F, 3}});
  // A threshold, a sunken place and a bag on the upper floor.
  builder.column(3, 0, {{0.0625F, 3}}).column(5, 0, {{-0.5F, 3}}).column(8, 0, {{0.75F, 3}});
  const auto grid = builder.build();
  const Picture picture = drawEpisodePlan({"hall", grid.view(), {}}, 800);
  const auto brightness = [&](double x) { return colorAt(picture, {x, 0.5}).g; };
  for (const double floor : {0.5, 3.5, 5.5, 7.5, 9.5}) EXPECT_GT(brightness(floor), 240) << floor;
  EXPECT_LT(brightness(1.5), 220);
  EXPECT_LT(brightness(8.5), 220);
}

TEST(EpisodePlanPicture, ShowsTheStoreyOfItsEpisodes) {
  GridBuilder builder(GridSpec{.heights = {-1, 7}, .columns_x = 10, .columns_z = 6});
  for (std::uint32_t k = 0; k < 6; ++k) {
    for (std::uint32_t i = 0; i < 10; ++i) builder.column(i, k, {{0, 2.5F}, {3, 5.5F}});
  }
  // A pillar downstairs, a table upstairs, and a hall that is as high as the house.
  builder.column(1, 0, {{3, 5.5F}});
  builder.column(3, 0, {{0, 2.5F}, {3.75F, 5.5F}}).column(5, 0, {{0, 5.5F}});
  // A cupboard downstairs.
  builder.column(7, 0, {{2, 2.5F}, {3, 5.5F}});
  const auto grid = builder.build();
  const auto brightness = [&](std::optional<float> floor, double x) {
    const Picture picture = drawEpisodePlan({"house", grid.view(), {}, floor}, 800);
    return colorAt(picture, {x, 0.5}).g;
  };
  for (const auto& floor : {std::optional<float>(0), std::optional<float>(0.1F)}) {
    EXPECT_GT(brightness(floor, 0.5), 240);
    EXPECT_LT(brightness(floor, 1.5), 120);
    EXPECT_GT(brightness(floor, 3.5), 240);
    EXPECT_GT(brightness(floor, 5.5), 240);
    EXPECT_LT(brightness(floor, 7.5), 220);
  }
  EXPECT_GT(brightness(3, 0.5), 240);
  EXPECT_GT(brightness(3, 1.5), 240);
  EXPECT_LT(brightness(3, 3.5), 220);
  EXPECT_LT(brightness(3, 5.5), 120);
  EXPECT_GT(brightness(3, 7.5), 240);
}

TEST(EpisodePlanPicture, LeavesOutMarksThatAreNowhere) {
  const auto grid = hall();
  const double nan = std::nan("");
  EpisodeMarks lost = tidyUp();
  lost.start = {nan, 3};
  lost.target = {1e30, -1e30};
  lost.goal = {-20, std::numeric_limits<double>::infinity()};
  lost.others = {{nan, nan}};
  const Picture picture = drawEpisodePlan({"hall", grid.view(), {lost}}, 800);
  EXPECT_EQ(colorAt(picture, {2, 3}), colorAt(picture, {9.5, 5.5}));
  const Picture blank = drawEpisodePlan({"hall", std::nullopt, {lost, tidyUp()}}, 800);
  EXPECT_GT(blank.image.width(), 800);
  const Picture empty = drawEpisodePlan({"hall", std::nullopt, {}}, 100);
  EXPECT_GT(empty.image.width(), 100);
}

TEST(EpisodePlanPicture, DrawsSmallerMarksWhereThereAreManyEpisodes) {
  const auto grid = hall();
  const auto colored = [&grid](std::size_t count) {
    const EpisodePlan plan{"hall", grid.view(), std::vector(count, tidyUp())};
    const Picture picture = drawEpisodePlan(plan, 800);
    std::size_t pixels = 0;
    const PixelRect& plot = picture.plots.front();
    for (int y = plot.y; y < plot.bottom(); ++y) {
      for (int x = plot.x; x < plot.right(); ++x) {
        pixels += picture.image.at(x, y) == kTargetMark ? 1U : 0U;
      }
    }
    return pixels;
  };
  EXPECT_EQ(colored(20), colored(100));
  EXPECT_LT(colored(1000), colored(100) / 2);
  EXPECT_GT(colored(2000), 4U);
}

TEST(EpisodePlanPicture, IsNoWiderForANameThatNeverEnds) {
  const auto grid = hall();
  const std::string endless(100000, 'n');
  const Picture picture = drawEpisodePlan({endless, grid.view(), {tidyUp()}}, 400);
  EXPECT_LT(picture.image.width(), 1400);
}

TEST(EpisodePlanPicture, MarksWhatIsAtTheEndsOfNarrowPlans) {
  EpisodeMarks marks = tidyUp();
  marks.start = {0, 0};
  marks.target = {0.2, 30};
  marks.goal = {0.3, 60};
  const Picture picture = drawEpisodePlan({"corridor", std::nullopt, {marks}}, 64);
  const PixelRect& plot = picture.plots.front();
  bool is_goal_there = false;
  for (int y = plot.bottom() - 5; y < plot.bottom(); ++y) {
    for (int x = plot.x; x < plot.right(); ++x) {
      is_goal_there = is_goal_there || picture.image.at(x, y) == kGoalMark;
    }
  }
  EXPECT_TRUE(is_goal_there);
}

TEST(EpisodeSheet, HasATileForEachSceneAndRefusesToBecomeHuge) {
  const auto grid = hall();
  const std::vector<EpisodePlan> plans(5, {"hall", grid.view(), {tidyUp()}});
  const auto sheet = drawEpisodeSheet(plans, 200);
  ASSERT_TRUE(sheet.has_value());
  EXPECT_GT(sheet->width(), 3 * 200);
  EXPECT_GT(sheet->height(), 2 * 200);
  EXPECT_LT(sheet->height(), 3 * 220);
  const auto huge = drawEpisodeSheet(std::vector<EpisodePlan>(10000), 2048);
  ASSERT_FALSE(huge.has_value());
  EXPECT_EQ(huge.error().code, ErrorCode::kUnsupported);
  EXPECT_THAT(huge.error().message, HasSubstr("a sheet of 10000 plans at 2048 pixels each"));
}

/// A kitchen with two episodes, and a hall with none.
class PacksOfPlans : public testing::Test {
 protected:
  PacksOfPlans() {
    test::ScenePackFields hall = test::smallScene();
    hall.name = "hall";
    write("kitchen.pack", test::asText(test::buildPack(test::smallScene()).bytes()));
    write("hall.pack", test::asText(test::buildPack(hall).bytes()));
    write("episodes.pack", test::asText(test::buildPack(test::smallEpisodes()).bytes()));
  }

  void write(const std::string& name, std::string_view bytes) {
    auto opened = PackFile::open(folder_.write(name, bytes));
    ASSERT_TRUE(opened) << opened.error().text();
    packs_.push_back(std::move(*opened));
  }

  Result<std::vector<EpisodePlan>> plans(const EpisodeChoice& choice = {}) {
    std::vector<const PackFile*> all;
    for (const PackFile& pack : packs_) all.push_back(&pack);
    return episodePlansOf(all, "home.pack", choice);
  }

  std::string errorOf(const EpisodeChoice& choice) {
    const auto result = plans(choice);
    return result ? "none" : result.error().message;
  }

  ScratchFolder folder_;
  std::vector<PackFile> packs_;
};

TEST_F(PacksOfPlans, BecomeAPlanForEachScene) {
  const auto result = plans();
  ASSERT_TRUE(result) << result.error().text();
  ASSERT_EQ(result->size(), 2U);
  EXPECT_EQ((*result)[0].scene, "hall");
  EXPECT_TRUE((*result)[0].episodes.empty());
  const EpisodePlan& kitchen = (*result)[1];
  EXPECT_EQ(kitchen.scene, "kitchen");
  ASSERT_TRUE(kitchen.grid);
  EXPECT_EQ(kitchen.grid->radius(), 0.5F);
  ASSERT_EQ(kitchen.episodes.size(), 2U);
  const EpisodeMarks& first = kitchen.episodes[0];
  EXPECT_EQ(first.start.x, 0.5);
  EXPECT_EQ(first.start.z, 0.25);
  EXPECT_EQ(first.yaw, 1.5);
  EXPECT_EQ(first.target.x, 1.5);
  EXPECT_EQ(first.goal.z, 1.5);
  EXPECT_EQ(first.others.size(), 2U);
}

TEST_F(PacksOfPlans, HaveOneForEachStoreyThatEpisodesBeginIn) {
  packs_.pop_back();
  test::EpisodePackFields episodes = test::smallEpisodes();
  episodes.episodes.push_back(episodes.episodes[1]);
  episodes.episodes[2].first_placement = 4;
  episodes.placements.push_back(episodes.placements[3]);
  episodes.start_positions.insert(episodes.start_positions.end(), {0.5F, 0.125F});
  episodes.episodes[0].base_position.y = 4;
  episodes.episodes[2].base_position.y = 1.5F;
  write("storeys.pack", test::asText(test::buildPack(episodes).bytes()));
  const auto all = plans({.scene = "kitchen"});
  ASSERT_TRUE(all) << all.error().text();
  ASSERT_EQ(all->size(), 2U);
  const auto numbersOf = [](const EpisodePlan& plan) {
    std::vector<std::size_t> numbers;
    for (const EpisodeMarks& marks : plan.episodes) numbers.push_back(marks.number);
    return numbers;
  };
  EXPECT_THAT(numbersOf((*all)[0]), ElementsAre(1, 2));
  EXPECT_THAT(numbersOf((*all)[1]), ElementsAre(0));
  EXPECT_EQ((*all)[0].floor, 1);
  EXPECT_EQ((*all)[1].floor, 4);
  EXPECT_EQ((*all)[1].storey, 2U);
  EXPECT_EQ((*all)[1].storeys, 2U);
  const auto upper = plans({.episode = 0});
  ASSERT_TRUE(upper) << upper.error().text();
  ASSERT_EQ(upper->size(), 1U);
  EXPECT_EQ(upper->front().floor, 4);
  EXPECT_EQ(upper->front().storeys, 1U);
}

TEST_F(PacksOfPlans, AreChosenByScenesEpisodesAndRadius) {
  const auto hall = plans({.scene = "hall", .radius = 0.75F});
  ASSERT_TRUE(hall) << hall.error().text();
  ASSERT_EQ(hall->size(), 1U);
  EXPECT_EQ(hall->front().scene, "hall");
  EXPECT_EQ(hall->front().grid->radius(), 0.75F);
  const auto second = plans({.episode = 1});
  ASSERT_TRUE(second) << second.error().text();
  ASSERT_EQ(second->size(), 1U);
  EXPECT_EQ(second->front().scene, "kitchen");
  ASSERT_EQ(second->front().episodes.size(), 1U);
  EXPECT_EQ(second->front().episodes.front().number, 1U);
}

TEST_F(PacksOfPlans, SayWhatIsNotThere) {
  EXPECT_EQ(errorOf({.scene = "kitchne"}), "has no scene \"kitchne\"; did you mean 'kitchen'?");
  EXPECT_EQ(errorOf({.episode = 2}), "has no episode 2; it has 2, numbered 0 to 1");
  EXPECT_EQ(errorOf({.scene = "hall", .episode = 0}),
            "episode 0 is not in the scene \"hall\"; leave out one of --episode and --scene");
  EXPECT_THAT(errorOf({.radius = 0.25F}), HasSubstr("has no grid of radius 0.25 m"));
  packs_.pop_back();
  EXPECT_THAT(errorOf({.episode = 0}), HasSubstr("has no episodes, wanted episode 0"));
  packs_.clear();
  EXPECT_THAT(errorOf({}), HasSubstr("has neither scenes nor episodes"));
}

struct Ran {
  int exit_code = 0;
  std::string err;
};

Ran run(const pack_tool::PictureOptions& options) {
  std::ostringstream out;
  std::ostringstream err;
  const int exit_code = pack_tool::runPicture(options, {out, err});
  return {exit_code, err.str()};
}

template <class Fields>
void writeTo(const ScratchFolder& folder, const std::string& name, const Fields& fields) {
  static_cast<void>(folder.write(name, test::asText(test::buildPack(fields).bytes())));
}

std::string pictureOf(const ScratchFolder& folder, const fs::path& pack) {
  const fs::path output = folder.path() / "picture.png";
  const Ran ran = run({.pack = pack, .output = output});
  EXPECT_EQ(ran.exit_code, kExitOk) << ran.err;
  return test::fileContent(output);
}

TEST(PictureOfAWorld, IsThatOfItsEpisodesBesideTheScenes) {
  const ScratchFolder folder;
  const std::string world = pictureOf(folder, writeWorld(folder, {}));
  writeTo(folder, "a/episodes.pack", test::smallEpisodes());
  const std::string alone = pictureOf(folder, folder.path() / "a/episodes.pack");
  EXPECT_NE(alone, world);
  writeTo(folder, "a/scenes/kitchen.pack", test::smallScene());
  EXPECT_EQ(pictureOf(folder, folder.path() / "a/episodes.pack"), world);
  writeTo(folder, "b/episodes.pack", test::smallEpisodes());
  writeTo(folder, "b/kitchen.pack", test::smallScene());
  EXPECT_EQ(pictureOf(folder, folder.path() / "b/episodes.pack"), world);
  // Of this file's name, but another scene.
  test::ScenePackFields hall = test::smallScene();
  hall.name = "hall";
  writeTo(folder, "b/kitchen.pack", hall);
  EXPECT_EQ(pictureOf(folder, folder.path() / "b/episodes.pack"), alone);
}

TEST(PictureOfAWorld, TellsOfAScenePackThatIsDamaged) {
  const ScratchFolder folder;
  writeTo(folder, "episodes.pack", test::smallEpisodes());
  static_cast<void>(folder.write("kitchen.pack", "no pack"));
  const Ran ran =
      run({.pack = folder.path() / "episodes.pack", .output = folder.path() / "picture.png"});
  EXPECT_EQ(ran.exit_code, 3);
  EXPECT_THAT(ran.err, HasSubstr("kitchen.pack"));
}

TEST(PictureOfAWorld, LooksForScenesInNoOtherFolder) {
  const ScratchFolder folder;
  test::EpisodePackFields fields = test::smallEpisodes();
  fields.scenes = {"../kitchen"};
  test::ScenePackFields scene = test::smallScene();
  scene.name = "../kitchen";
  writeTo(folder, "kitchen.pack", scene);
  writeTo(folder, "a/episodes.pack", fields);
  const std::string alone = pictureOf(folder, folder.path() / "a/episodes.pack");
  fs::remove(folder.path() / "kitchen.pack");
  EXPECT_EQ(pictureOf(folder, folder.path() / "a/episodes.pack"), alone);
}

TEST(PictureOfAWorld, RefusesWhatIsForOtherPacks) {
  const ScratchFolder folder;
  const fs::path world = writeWorld(folder, {});
  const fs::path output = folder.path() / "a.png";
  const auto errorOf = [&](pack_tool::PictureOptions options) {
    options.pack = world;
    options.output = output;
    const Ran ran = run(options);
    EXPECT_EQ(ran.exit_code, static_cast<int>(ErrorCode::kInvalidInput));
    return ran.err;
  };
  EXPECT_THAT(errorOf({.grids = {.value = PlanValue::kSpanCount}}),
              HasSubstr("is a pack of kind WRLD and holds no column grids"));
  EXPECT_THAT(errorOf({.figures = pack_tool::FigureOptions{}}),
              HasSubstr("is a pack of kind WRLD and is drawn from above"));
  EXPECT_THAT(errorOf({.episodes = {.episode = 9}}), HasSubstr("has no episode 9"));
  EXPECT_FALSE(fs::exists(output));
}

}  // namespace
}  // namespace galactic::pictures::episode_plan_test
