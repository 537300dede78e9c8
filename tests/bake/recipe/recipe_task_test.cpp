// The table [task] of a world's recipe: every option of the table of options, and every mistake.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "recipe/world_recipe.h"
#include "support/option_table.h"
#include "support/scratch_folder.h"

namespace galactic::test::recipe_task_test {
namespace {

using bake::WorldRecipe;
using testing::ElementsAre;
using testing::IsEmpty;

constexpr const char* kScene = "[[scenes]]\nfiles = \"a.glb\"\n";  // Lines 1 and 2.

class RecipeTask : public testing::Test {
 protected:
  /// With these lines of [task], of which the first is line 4.
  [[nodiscard]] Result<WorldRecipe> read(const std::string& lines) const {
    return bake::readWorldRecipe(folder_.write("w.toml", kScene + ("[task]\n" + lines)));
  }
  [[nodiscard]] std::string place(int line) const {
    return fmt::format("{}:{}", (folder_.path() / "w.toml").string(), line);
  }
  /// NAME=VALUE of each option.
  [[nodiscard]] std::vector<std::string> taskOf(const std::string& lines) const {
    const auto recipe = read(lines);
    EXPECT_TRUE(recipe.has_value()) << recipe.error().text();
    std::vector<std::string> texts;
    if (!recipe) return texts;
    for (const OptionText& option : recipe->task) {
      texts.push_back(option.name + "=" + option.value);
    }
    return texts;
  }

  ScratchFolder folder_;
};

TEST_F(RecipeTask, GivesItsOptionsInTheOrderOfTheTable) {
  EXPECT_THAT(taskOf("slide-step = 0.05\nsafe-drop = true\nepisode-steps = 300\n"
                     "success-distance = 0.15\ntask = \"pick\"\n"),
              ElementsAre("task=pick", "episode-steps=300", "success-distance=0.15",
                          "safe-drop=true", "slide-step=0.05"));
  EXPECT_THAT(taskOf(""), IsEmpty());
}

TEST_F(RecipeTask, TakesWholeNumbersAsRealOnesAndSwitchesThatAreOff) {
  EXPECT_THAT(taskOf("pick-reward = -2\nfloor-rise = 0.5\nno-distractors = false\n"
                     "slack-penalty = 1e-3\nsuccess-reward = 0.30000000000000004\n"),
              ElementsAre("no-distractors=false", "success-reward=0.3", "pick-reward=-2",
                          "slack-penalty=0.001", "floor-rise=0.5"));
}

TEST_F(RecipeTask, GivesThePartsOfAPresetWhichRefineIt) {
  EXPECT_THAT(taskOf("slide = \"published\"\n"),
              ElementsAre("slide-direction=towards-base", "slide-attempts=5", "slide-step=0.05"));
  EXPECT_THAT(taskOf("slide-attempts = 2\nslide = \"published\"\n"),
              ElementsAre("slide-direction=towards-base", "slide-attempts=2", "slide-step=0.05"));
  EXPECT_THAT(taskOf("slide = \"off\"\n"),
              ElementsAre("slide-direction=glide", "slide-attempts=0", "slide-step=0.15"));
}

TEST_F(RecipeTask, TakesRangesThatEpisodesDrawFrom) {
  EXPECT_THAT(taskOf("motion-noise = \"0.2-0.8\"\nmotion-bias = 0.1\nlaser-noise = 1\n"),
              ElementsAre("motion-noise=0.2-0.8", "motion-bias=0.1", "laser-noise=1"));
  EXPECT_THAT(taskOf("action-delay = 2\n"), ElementsAre("action-delay=2"));
  EXPECT_THAT(taskOf("action-delay = \"0-3\"\n"), ElementsAre("action-delay=0-3"));
}

TEST_F(RecipeTask, KnowsEveryOptionOfTheTask) {
  std::string lines;
  std::size_t count = 0;
  for (const OptionText& option : listOptions({}, OptionScope::kTask)) {
    lines += option.is_word ? fmt::format("{} = \"{}\"\n", option.name, option.value)
                            : fmt::format("{} = {}\n", option.name, option.value);
    ++count;
  }
  const auto recipe = read(lines);
  ASSERT_TRUE(recipe.has_value()) << recipe.error().text();
  EXPECT_EQ(recipe->task.size(), count);
  EXPECT_EQ(recipe->task, listOptions({}, OptionScope::kTask));
}

TEST_F(RecipeTask, RefusesEachMistakeWithItsLine) {
  const std::vector<std::pair<std::string, std::string>> mistakes{
      {"episode-steps = -1",
       "task.episode-steps: found -1, expected a whole number from 0 to 1073741824"},
      {"episode-steps = 1073741825",
       "task.episode-steps: found 1073741825, expected a whole number from 0 to 1073741824"},
      {"episode-steps = 300.0", "task.episode-steps: found 300, expected a whole number from 0 to"},
      {"episode-steps = \"300\"",
       "task.episode-steps: found \"300\", expected a whole number from 0 to"},
      {"episode-steps = true", "task.episode-steps: found true, expected a whole number from 0 to"},
      {"episode-steps = [300]",
       "task.episode-steps: found a list, expected a whole number from 0 to"},
      {"episode-steps = { a = 1 }",
       "task.episode-steps: found a table, expected a whole number from 0"},
      {"success-distance = -0.5",
       "task.success-distance: found -0.5, expected a number from 0 to 1000"},
      {"success-distance = 1e4",
       "task.success-distance: found 10000, expected a number from 0 to 1000"},
      {"success-distance = nan",
       "task.success-distance: found nan, expected a number from 0 to 1000"},
      {"success-distance = inf",
       "task.success-distance: found inf, expected a number from 0 to 1000"},
      {"success-distance = \"0.1\"",
       "task.success-distance: found \"0.1\", expected a number from 0 to"},
      {"safe-drop = 1", "task.safe-drop: found 1, expected true or false"},
      {"safe-drop = \"true\"", "task.safe-drop: found \"true\", expected true or false"},
      {"task = \"fly\"", "task.task: found \"fly\", expected rearrange, pick or none"},
      {"task = 1", "task.task: found 1, expected rearrange, pick or none"},
      {"slide = \"up\"", "task.slide: found \"up\", expected glide, published or off"},
      {"slide = false", "task.slide: found false, expected glide, published or off"},
      {"slide-direction = \"off\"",
       "task.slide-direction: found \"off\", expected glide or towards-base"},
      {"grasp-from = 3", "task.grasp-from: found 3, expected a number from -2 to 2"},
      {"episode-step = 3",
       "the key task.episode-step is unknown; did you mean 'episode-steps' or 'slide-step'?"},
      {"safe_drop = true", "the key task.safe_drop is unknown; did you mean 'safe-drop'?"},
      {"wings = 2", "the key task.wings is unknown; "},
      {"action-delay = -1",
       "task.action-delay: found -1, expected a whole number from 0 to 100, or"},
      {"action-delay = 1.5", "task.action-delay: found 1.5, expected a whole number from 0 to 100"},
      {"action-delay = 4294967298", "task.action-delay: found 4294967298, expected a whole number"},
      {"action-delay = \"3-1\"", "task.action-delay: found \"3-1\", expected a whole number from"},
      {"motion-noise = 1.5", "task.motion-noise: found 1.5, expected 0 to 1, or a range from 0 to"},
      {"motion-noise = nan", "task.motion-noise: found nan, expected 0 to 1, or a range from 0 to"},
      {"motion-noise = \"0.8-0.2\"", "task.motion-noise: found \"0.8-0.2\", expected 0 to 1, or a"},
      {"motion-noise = [0.2, 0.8]", "task.motion-noise: found a list, expected 0 to 1, or a range"},
      {"envs = 5", "task.envs says how a batch runs, not what its task is; give it to "},
      {"seed = 5", "task.seed says how a batch runs, not what its task is; give it to "},
      {"order = \"linear\"", "task.order says how a batch runs, not what its task is; give it to "},
      {"threads = 5", "the key task.threads is unknown; "},
  };
  for (const auto& [line, message] : mistakes) {
    SCOPED_TRACE(line);
    const auto recipe = read("pick-reward = 1\n" + line + "\n");
    ASSERT_FALSE(recipe.has_value());
    EXPECT_EQ(recipe.error().code, ErrorCode::kInvalidInput);
    EXPECT_EQ(recipe.error().where, place(5));
    EXPECT_THAT(recipe.error().message, testing::StartsWith(message));
  }
}

TEST_F(RecipeTask, IsATable) {
  const auto word =
      bake::readWorldRecipe(folder_.write("w.toml", "task = \"pick\"\n" + std::string(kScene)));
  ASSERT_FALSE(word.has_value());
  EXPECT_EQ(word.error().where, place(1));
  EXPECT_EQ(word.error().message, "task: expected a table, [task]");
  const auto list =
      bake::readWorldRecipe(folder_.write("w.toml", std::string(kScene) + "[[task]]\n"));
  ASSERT_FALSE(list.has_value());
  EXPECT_EQ(list.error().message, "task: expected a table, [task]");
}

}  // namespace
}  // namespace galactic::test::recipe_task_test
