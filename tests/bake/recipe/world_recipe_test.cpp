// Recipes of worlds: what every table may say, and every mistake with its line.
#include "recipe/world_recipe.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/build_paths.h"
#include "support/scratch_folder.h"

namespace galactic::test::world_recipe_test {
namespace {

namespace fs = std::filesystem;
using bake::GivenOption;
using bake::GivenWord;
using bake::RecipeAssets;
using bake::WorldRecipe;
using testing::ElementsAre;
using testing::IsEmpty;

constexpr const char* kWholeRecipe =
    "[bake]\n"                                            // 1
    "radii = [0.05, 0.1]\n"                               // 2
    "no-render-meshes = true\n"                           // 3
    "allow-missing = false\n"                             // 4
    "[[scenes]]\n"                                        // 5
    "dataset = \"a.scene_dataset_config.json\"\n"         // 6
    "scenes = [\"v3_*\", \"v2_*\"]\n"                     // 7
    "missing = \"skip\"\n"                                // 8
    "[[scenes]]\n"                                        // 9
    "files = [\"kitchen.glb\", \"halls/*.glb\"]\n"        // 10
    "keep-components = 2\n"                               // 11
    "[[objects]]\n"                                       // 12
    "files = \"ycb\"\n"                                   // 13
    "up = \"z\"\n"                                        // 14
    "eps = 0.0625\n"                                      // 15
    "[robot]\n"                                           // 16
    "files = \"fetch.urdf\"\n"                            // 17
    "recipe = \"fetch.toml\"\n"                           // 18
    "package = { fetch = \"meshes\", arm = \"more\" }\n"  // 19
    "[episodes]\n"                                        // 20
    "count = 10\n"                                        // 21
    "goal-elsewhere = true\n";                            // 22

class WorldRecipeFile : public testing::Test {
 protected:
  [[nodiscard]] Result<WorldRecipe> read(const std::string& text) const {
    return bake::readWorldRecipe(folder_.write("w.toml", text));
  }
  [[nodiscard]] std::string place(int line) const {
    return fmt::format("{}:{}", (folder_.path() / "w.toml").string(), line);
  }
  ScratchFolder folder_;
};

struct WordText {
  std::string operator()(bool truth) const { return truth ? "true" : "false"; }
  std::string operator()(std::int64_t whole) const { return fmt::format("{}", whole); }
  std::string operator()(double real) const { return fmt::format("{}", real); }
  std::string operator()(const std::string& text) const { return text; }
};

/// "NAME|value|value"; commas between the words of a value.
std::vector<std::string> textsOf(const std::vector<GivenOption>& options) {
  std::vector<std::string> texts;
  for (const GivenOption& option : options) {
    texts.push_back(option.name);
    for (const bake::GivenValue& value : option.values) {
      texts.back() += "|" + value.name + (value.name.empty() ? "" : "=");
      for (const GivenWord& word : value.words) {
        if (&word != value.words.data()) texts.back() += ",";
        texts.back() += std::visit(WordText{}, word);
      }
    }
  }
  return texts;
}

TEST_F(WorldRecipeFile, IsReadTableByTable) {
  const auto recipe = read(kWholeRecipe);
  ASSERT_TRUE(recipe.has_value()) << recipe.error().text();
  EXPECT_THAT(textsOf(recipe->common),
              ElementsAre("allow-missing|false", "no-render-meshes|true", "radii|0.05,0.1"));
  ASSERT_EQ(recipe->scenes.size(), 2U);
  EXPECT_TRUE(recipe->scenes[0].is_dataset);
  EXPECT_THAT(recipe->scenes[0].inputs, ElementsAre("a.scene_dataset_config.json"));
  EXPECT_THAT(textsOf(recipe->scenes[0].options), ElementsAre("missing|skip", "scenes|v3_*|v2_*"));
  EXPECT_FALSE(recipe->scenes[1].is_dataset);
  EXPECT_THAT(recipe->scenes[1].inputs, ElementsAre("kitchen.glb", "halls/*.glb"));
  EXPECT_THAT(textsOf(recipe->scenes[1].options), ElementsAre("keep-components|2"));
  ASSERT_EQ(recipe->objects.size(), 1U);
  EXPECT_THAT(recipe->objects[0].inputs, ElementsAre("ycb"));
  EXPECT_THAT(textsOf(recipe->objects[0].options), ElementsAre("eps|0.0625", "up|z"));
  ASSERT_TRUE(recipe->robot.has_value());
  EXPECT_THAT(textsOf(recipe->robot->options),
              ElementsAre("package|arm=more|fetch=meshes", "recipe|fetch.toml"));
  ASSERT_TRUE(recipe->episodes.has_value());
  EXPECT_THAT(recipe->episodes->inputs, IsEmpty());
  EXPECT_THAT(textsOf(recipe->episodes->options), ElementsAre("count|10", "goal-elsewhere|true"));
}

TEST_F(WorldRecipeFile, KnowsTheLineOfEachTableAndOption) {
  const auto recipe = read(kWholeRecipe);
  ASSERT_TRUE(recipe.has_value());
  EXPECT_EQ(recipe->common[2].place, place(2) + ": radii");
  EXPECT_EQ(recipe->scenes[0].place, place(5));
  EXPECT_EQ(recipe->scenes[1].place, place(9));
  EXPECT_EQ(recipe->scenes[1].options[0].place, place(11) + ": keep-components");
  EXPECT_EQ(recipe->robot->place, place(16));
  EXPECT_EQ(recipe->episodes->options[0].place, place(21) + ": count");
}

TEST_F(WorldRecipeFile, NeedsNothingButAScene) {
  const auto recipe = read("[[scenes]]\nfiles = \"a.glb\"\n");
  ASSERT_TRUE(recipe.has_value());
  EXPECT_THAT(recipe->common, IsEmpty());
  EXPECT_THAT(recipe->objects, IsEmpty());
  EXPECT_FALSE(recipe->robot.has_value());
  EXPECT_FALSE(recipe->episodes.has_value());
}

TEST_F(WorldRecipeFile, WritesNumbersSoThatTheyReadBackTheSame) {
  const auto recipe = read(
      "[[scenes]]\nfiles = \"a.glb\"\nspacing = 0.1\ntransform = [1, -2.5, 1e-7, "
      "0.30000000000000004]\n"
      "count = -12\nup = [ \"x\" ]\n");
  ASSERT_TRUE(recipe.has_value());
  EXPECT_THAT(textsOf(recipe->scenes[0].options),
              ElementsAre("count|-12", "spacing|0.1", "transform|1,-2.5,1e-07,0.30000000000000004",
                          "up|x"));
}

/// A mistake, its line (0: none) and the whole message.
struct Mistake {
  std::string text;
  int line;
  std::string message;
};

TEST_F(WorldRecipeFile, RefusesEachMistakeWithItsLine) {
  const std::string scene = "[[scenes]]\nfiles = \"a.glb\"\n";
  const std::vector<Mistake> mistakes{
      {"", 0, "names no scenes; begin a table [[scenes]] with files or a dataset"},
      {"[robot]\nfiles = \"r.urdf\"\n", 0,
       "names no scenes; begin a table [[scenes]] with files or a dataset"},
      {"[[scenes]]\nup = \"z\"\n", 1, "[[scenes]] names no files and no dataset"},
      {"[[scenes]]\nfiles = []\n", 1, "[[scenes]] names no files and no dataset"},
      {"[[scenes]]\nfiles = \"\"\n", 2, "files: a name is empty; name a file or a folder"},
      {"[[scenes]]\ndataset = [\"a\", \"\"]\n", 2,
       "dataset: a name is empty; name a file or a folder"},
      {scene + "[[objects]]\nup = \"z\"\n", 3, "[[objects]] names no files"},
      {"scenes = \"a.glb\"\n", 1, "scenes: expected a list"},
      {"[scenes]\nfiles = \"a.glb\"\n", 1, "scenes: expected a list"},
      {"scenes = [\"a.glb\"]\n", 1, "scenes: expected an array of tables, [[scenes]]"},
      {scene + "[objects]\nfiles = \"o\"\n", 3, "objects: expected a list"},
      {scene + "[[robot]]\nfiles = \"r.urdf\"\n", 3, "robot: expected a table, [robot]"},
      {"episodes = 3\n" + scene, 1, "episodes: expected a table, [episodes]"},
      {"bake = 3\n" + scene, 1, "bake: expected a table, [bake]"},
      {"[[scenes]]\nfiles = \"a\"\ndataset = \"b\"\n", 2,
       "both files and dataset are given; keep one of them"},
      {"[[scenes]]\nfiles = 3\n", 2, "files: expected a string or a list of strings"},
      {"[[scenes]]\nfiles = [\"a\", 3]\n", 2, "files: expected a string or a list of strings"},
      {"[[scenes]]\ndataset = { a = \"b\" }\n", 2,
       "dataset: expected a string or a list of strings"},
      {scene + "[robots]\nfiles = \"r\"\n", 3, "the key robots is unknown; did you mean 'robot'?"},
      {"radii = 3\n" + scene, 1,
       "the key radii is unknown; known are 'bake', 'scenes', 'objects', 'robot', 'episodes', "
       "'task'"},
  };
  for (const Mistake& mistake : mistakes) {
    SCOPED_TRACE(mistake.text);
    const auto recipe = read(mistake.text);
    ASSERT_FALSE(recipe.has_value());
    EXPECT_EQ(recipe.error().code, ErrorCode::kInvalidInput);
    const std::string file = (folder_.path() / "w.toml").string();
    EXPECT_EQ(recipe.error().where, mistake.line == 0 ? file : place(mistake.line));
    EXPECT_EQ(recipe.error().message, mistake.message);
  }
}

TEST_F(WorldRecipeFile, RefusesValuesThatAreNone) {
  for (const char* value : {"[{ a = 1 }]", "[[[1]]]", "{ a = [1] }", "{}", "[[]]"}) {
    const auto recipe = read(fmt::format("[[scenes]]\nfiles = \"a\"\nradii = {}\n", value));
    ASSERT_FALSE(recipe.has_value()) << value;
    EXPECT_EQ(recipe.error().where, place(3) + ": radii");
  }
}

TEST_F(WorldRecipeFile, RefusesWhatIsNoToml) {
  const auto broken = read("[[scenes]]\nfiles = \n");
  ASSERT_FALSE(broken.has_value());
  EXPECT_EQ(broken.error().code, ErrorCode::kInvalidInput);
  EXPECT_EQ(broken.error().where, place(2));
  const auto missing = bake::readWorldRecipe(folder_.path() / "none.toml");
  ASSERT_FALSE(missing.has_value());
  EXPECT_EQ(missing.error().code, ErrorCode::kIo);
  const auto a_folder = bake::readWorldRecipe(folder_.path());
  ASSERT_FALSE(a_folder.has_value());
  EXPECT_EQ(a_folder.error().code, ErrorCode::kIo);
}

TEST_F(WorldRecipeFile, ThatComeWithTheProjectAreRead) {
  std::size_t count = 0;
  for (const auto& entry : fs::directory_iterator(test::sourceFolder() / "packs/worlds")) {
    if (entry.path().extension() != ".toml") continue;
    const auto recipe = bake::readWorldRecipe(entry.path());
    EXPECT_TRUE(recipe.has_value()) << recipe.error().text();
    ++count;
  }
  EXPECT_GE(count, 1U);
}

}  // namespace
}  // namespace galactic::test::world_recipe_test
