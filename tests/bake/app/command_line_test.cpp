// Every option of the tool, with everything that is no value of it.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <regex>
#include <set>

#include "bake/options/option_walk.h"
#include "command.h"
#include "support/scratch_folder.h"

namespace galactic::bake::command_line_test {
namespace {

using test::WalkedOption;
using testing::HasSubstr;
using testing::StartsWith;
using Texts = std::vector<std::string>;

const Texts kScene{"room.glb"};
const Texts kObject{"--as", "object", "mug.glb"};
const Texts kRobot{"robot.urdf"};
/// A seed is for starts that are drawn in packs.
const Texts kImport{"home.episode_set.json", "home.pack"};
const Texts kGenerate{"--as", "episodes", "home.pack"};
const Texts kLink{"--as", "world", "a.pack", "b.pack"};
const Texts kDataset{"home.scene_dataset_config.json"};
const Texts kRecipe{"home.toml"};

/// What a command line made: a command, or an exit code and what stood on stderr.
struct Parsed {
  ParsedCommand command;
  std::string said;

  [[nodiscard]] bool isRefused() const { return std::holds_alternative<int>(command); }
};

Parsed parse(const Texts& arguments) {
  std::vector<const char*> argv{"galactic-bake"};
  for (const std::string& argument : arguments) argv.push_back(argument.c_str());
  testing::internal::CaptureStderr();
  Parsed parsed{parseCommandLine(static_cast<int>(argv.size()), argv.data()), {}};
  std::fflush(stderr);
  parsed.said = testing::internal::GetCapturedStderr();
  return parsed;
}

Texts with(Texts arguments, const std::string& more) {
  arguments.push_back(more);
  return arguments;
}

/// Options, and arguments with which they make sense.
struct Walked {
  Texts base;
  std::vector<WalkedOption> options;
};

const std::vector<Walked>& allOptions() {
  static const std::vector<Walked> all{{kScene, test::walk(ToolOptions{})},
                                       {kScene, test::walk(SceneJob{})},
                                       {kObject, test::walk(ObjectJob{})},
                                       {kRobot, test::walk(RobotJob{})},
                                       {kImport, test::walk(EpisodeImportJob{})},
                                       {kGenerate, test::walk(EpisodeGenerationJob{})},
                                       {kLink, test::walk(WorldJob{})},
                                       {kDataset, test::walk(DatasetCommand{})},
                                       {kDataset, test::walk(ManyPacksOptions{})},
                                       {kRecipe, test::walk(RecipeCommand{})}};
  return all;
}

/// What no option of a kind takes.
const Texts& badValues(OptionKind kind) {
  static const Texts no_switch{"maybe", "2.5", "nan"};
  static const Texts no_choice{"", "nonsense", "ALL", "1", "nan", "-1"};
  static const Texts no_whole{
      "",    "nan", "inf", "-inf", "-1",  "-0",  "010", "1.5",
      "1e2", "+1",  "0x1", "abc",  "1,2", "1 2", "--1", "99999999999999999999999"};
  static const Texts no_number{"",    "nan", "-nan", "inf", "-inf", "1e999", "1e300", "-1",
                               "abc", "1,2", "1 2",  " ",   "--1",  "0x10",  "+1"};
  static const Texts no_numbers{"",     "nan", "inf", "-inf", "1e999", "1e300", "abc",
                                "1,,2", ",1",  "1,",  "1 2",  " ",     "0x10",  "1,nan,2"};
  static const Texts no_text{""};
  static const Texts no_pair{"", "a", "=b", "a=", "="};
  switch (kind) {
    case OptionKind::kSwitch:
      return no_switch;
    case OptionKind::kChoice:
      return no_choice;
    case OptionKind::kWhole:
      return no_whole;
    case OptionKind::kNumber:
      return no_number;
    case OptionKind::kNumbers:
      return no_numbers;
    case OptionKind::kNamedText:
    case OptionKind::kNamedPath:
      return no_pair;
    case OptionKind::kText:
    case OptionKind::kPath:
      break;
  }
  return no_text;
}

/// PROGRAM: WHERE: MESSAGE, in one line.
void expectRefusal(const Parsed& parsed, const std::string& option) {
  ASSERT_TRUE(parsed.isRefused());
  EXPECT_EQ(std::get<int>(parsed.command), kExitUsage);
  EXPECT_THAT(parsed.said, StartsWith("galactic-bake: "));
  EXPECT_THAT(parsed.said, HasSubstr("--" + option));
  EXPECT_EQ(std::count(parsed.said.begin(), parsed.said.end(), '\n'), 1) << parsed.said;
}

TEST(CommandLine, RefusesWhatIsNoValueOfAnOption) {
  std::size_t refused = 0;
  for (const auto& [base, options] : allOptions()) {
    for (const WalkedOption& option : options) {
      for (const std::string& value : badValues(option.kind)) {
        SCOPED_TRACE(fmt::format("--{}={}", option.name, value));
        expectRefusal(parse(with(base, fmt::format("--{}={}", option.name, value))), option.name);
        ++refused;
      }
    }
  }
  EXPECT_GT(refused, 500U);
}

TEST(CommandLine, RefusesOptionsThatAreGivenTwice) {
  std::size_t refused = 0;
  for (const auto& [base, options] : allOptions()) {
    for (const WalkedOption& option : options) {
      if (option.repeats || option.kind == OptionKind::kSwitch) continue;
      SCOPED_TRACE(option.name);
      const std::string once = fmt::format("--{}=1", option.name);
      const Parsed parsed = parse(with(with(base, once), once));
      expectRefusal(parsed, option.name);
      EXPECT_THAT(parsed.said, HasSubstr("is given twice; give it once"));
      ++refused;
    }
  }
  EXPECT_GT(refused, 40U);
}

TEST(CommandLine, TakesAValueOfEveryOption) {
  const std::set<std::string> needs_another{"held-out", "split-seed", "inside", "collection"};
  for (const auto& [base, options] : allOptions()) {
    for (const WalkedOption& option : options) {
      if (needs_another.contains(option.name)) continue;
      SCOPED_TRACE(option.name);
      const bool is_taken = std::ranges::any_of(test::candidateValues(), [&](const auto& value) {
        return !parse(with(base, fmt::format("--{}={}", option.name, value))).isRefused();
      });
      EXPECT_TRUE(is_taken);
    }
  }
}

/// All long options of --help.
std::set<std::string> optionsOfHelp() {
  testing::internal::CaptureStdout();
  const Parsed parsed = parse({"--help"});
  std::fflush(stdout);
  const std::string help = testing::internal::GetCapturedStdout();
  EXPECT_EQ(std::get<int>(parsed.command), 0);
  std::set<std::string> options;
  const std::regex option(R"((?:^|\n)\s+(?:-\w,)?--([a-z-]+))");
  for (std::sregex_iterator at(help.begin(), help.end(), option), end; at != end; ++at) {
    options.insert((*at)[1]);
  }
  return options;
}

TEST(CommandLine, ExplainsEveryOptionInHelp) {
  std::set<std::string> names{"as", "config", "help", "print-recipe", "version"};
  for (const auto& [base, options] : allOptions()) {
    for (const WalkedOption& option : options) names.insert(option.name);
  }
  EXPECT_EQ(optionsOfHelp(), names);
}

TEST(CommandLine, RefusesWhatWouldBeIgnored) {
  struct Pair {
    Texts arguments;
    std::string said;
  };
  for (const Pair& pair : std::vector<Pair>{
           {{"room.glb", "--inside", "0,1,0", "--keep-components", "2"},
            "--keep-components: does not go with --inside"},
           {{"room.glb", "--keep", "all", "--inside", "0,1,0"},
            "--inside: says what the room is, and --keep all stores"},
           {{"room.glb", "--keep", "all", "--keep-components", "2"},
            "--keep-components: says what the room is, and --keep all"},
           {{"room.glb", "--no-render-meshes", "--texture-size", "64"},
            "--texture-size: does not go with --no-render-meshes"},
           {{"robot.urdf", "--obb", "min"}, "--obb: does not go with --as robot"},
           {{"robot.urdf", "--no-support"}, "--no-support: does not go with --as robot"},
           {{"--as", "world", "a.pack", "b.pack", "--shard", "1/2"},
            "--shard: does not go with --as world of packs"},
           {{"--as", "world", "a.pack", "--memory", "2"}, "--memory: does not go with --as world"},
           {{"home.scene_dataset_config.json", "--data", "dir"},
            "--data: does not go with --as dataset"},
           {{"home.toml", "--eps", "0.1"}, "--eps: does not go with a world's recipe"},
           {{"--as", "episodes", "a.pack", "--held-out", "0.1"}, "--held-out: is about --split"},
           {{"--as", "episodes", "a.pack", "--split-seed", "3"}, "--split-seed: is about --split"},
           {{"home.scene_dataset_config.json", "--inside", "0,1,0"}, "--inside: is a point of one"},
           {{"room.glb", "--quiet", "--verbose"}, "--verbose: does not go with --quiet"},
           {{"room.glb", "--as", "scene", "--as", "scene"}, "command line: --as: "},
           {{"room.glb", "--as", "house"}, "--as: is \"house\", expected one of scene, object"},
           {{"home.episode_set.json", "--start-joints", "a,,b"},
            "--start-joints: has an empty name"}}) {
    const Parsed parsed = parse(pair.arguments);
    ASSERT_TRUE(parsed.isRefused()) << pair.said;
    EXPECT_THAT(parsed.said, StartsWith("galactic-bake: " + pair.said));
  }
}

TEST(CommandLine, SuggestsTheNearestOption) {
  EXPECT_THAT(parse({"room.glb", "--radi", "0.1"}).said, HasSubstr("did you mean '--radii'?"));
}

/// The keys of all packs of a recipe's world.
std::set<std::string> keysOf(const Parsed& parsed) {
  std::set<std::string> keys;
  if (parsed.isRefused()) return keys;
  BakeLibraries libraries;
  const auto plan = planOf(std::get<BakeCommand>(parsed.command), libraries);
  EXPECT_TRUE(plan.has_value()) << plan.error().text();
  if (!plan) return keys;
  for (const PackJob& pack : plan->assets) keys.insert(keyOf(pack.job, pack.folder));
  return keys;
}

/// The options of the generated episodes of a recipe, with these arguments.
const EpisodeGeneratorOptions* episodesOf(const WorldPlan& plan) {
  const auto* job =
      plan.episodes ? std::get_if<EpisodeGenerationJob>(&plan.episodes->job) : nullptr;
  return job == nullptr ? nullptr : &job->generate;
}

TEST(Recipes, MakeSeveralWorldsThatDifferInTheirEpisodes) {
  const test::ScratchFolder folder;
  for (const char* name : {"room.glb", "mug.glb", "arm.urdf", "arm.toml"}) {
    ASSERT_FALSE(folder.write(name, "text").empty());
  }
  const std::string head =
      "[[scenes]]\nfiles = \"room.glb\"\n[[objects]]\nfiles = \"mug.glb\"\n"
      "[robot]\nfiles = \"arm.urdf\"\nrecipe = \"arm.toml\"\n";
  const std::string recipe =
      folder.write("home.toml", head + "[episodes]\ncount = 1000\nseed = 101\nflatness = 0.01\n")
          .string();
  BakeLibraries libraries;
  const auto plan = planOf(*commandFrom({recipe, "--seed", "303", "--count", "100"}), libraries);
  ASSERT_TRUE(plan) << plan.error().text();
  const EpisodeGeneratorOptions* validation = episodesOf(*plan);
  ASSERT_NE(validation, nullptr);
  EXPECT_EQ(validation->episodes, 100U);
  EXPECT_EQ(validation->seed, 303U);
  EXPECT_EQ(validation->flatness, 0.01F);
  const auto same = planOf(*commandFrom({recipe}), libraries);
  ASSERT_TRUE(same) << same.error().text();
  EXPECT_EQ(episodesOf(*same)->episodes, 1000U);
  EXPECT_EQ(episodesOf(*same)->seed, 101U);
  // Everything but the episodes has the same keys in the cache.
  EXPECT_EQ(plan->assets.size(), same->assets.size());
  for (std::size_t n = 0; n < plan->assets.size(); ++n) {
    EXPECT_EQ(keyOf(plan->assets[n].job, ""), keyOf(same->assets[n].job, ""));
  }

  const auto without =
      planOf(*commandFrom({folder.write("none.toml", head).string(), "--seed", "3"}), libraries);
  ASSERT_FALSE(without);
  EXPECT_EQ(without.error().text(),
            "seed: is about episodes that are generated, and the recipe has none; leave it out, or "
            "give the recipe a table [episodes] without `files`");
}

TEST(Recipes, GiveEpisodesThatTheyImportThePacksForTheirStarts) {
  const test::ScratchFolder folder;
  for (const char* name : {"room.glb", "mug.glb", "arm.urdf", "tidy.json.gz"}) {
    ASSERT_FALSE(folder.write(name, "text").empty());
  }
  const std::string scenes = "[[scenes]]\nfiles = \"room.glb\"\n";
  const std::string rest = "[[objects]]\nfiles = \"mug.glb\"\n[robot]\nfiles = \"arm.urdf\"\n";
  const std::string episodes = "[episodes]\nfiles = \"tidy.json.gz\"\n";
  BakeLibraries libraries;
  const auto plan = [&](const std::string& recipe, std::vector<std::string> more) {
    more.insert(more.begin(), folder.write("home.toml", recipe).string());
    return planOf(*commandFrom(more), libraries);
  };
  const auto whole = plan(scenes + rest + episodes, {"--seed", "7", "-o", "home.pack"});
  ASSERT_TRUE(whole) << whole.error().text();
  const auto& import = std::get<EpisodeImportJob>(whole->episodes->job);
  EXPECT_EQ(import.seed, 7U);
  EXPECT_THAT(import.packs, testing::ElementsAre("home/objects/mug.pack", "home/robot.pack",
                                                 "home/scenes/room.pack"));
  // Nothing is drawn without a robot.
  const auto bare = plan(scenes + episodes, {});
  ASSERT_TRUE(bare) << bare.error().text();
  EXPECT_THAT(std::get<EpisodeImportJob>(bare->episodes->job).packs, testing::IsEmpty());
  const auto counted = plan(scenes + rest + episodes, {"--count", "7"});
  ASSERT_FALSE(counted);
  EXPECT_THAT(counted.error().text(), testing::HasSubstr("count: is about episodes that are "
                                                         "generated, and the recipe imports its "
                                                         "own"));
}

TEST(Recipes, TakeNoOptionsOfTheCommandLine) {
  BakeLibraries libraries;
  const test::ScratchFolder folder;
  const auto mesh = folder.write("a.glb", "a mesh");
  ASSERT_FALSE(mesh.empty());
  std::size_t refused = 0;
  for (const WalkedOption& option : test::walk(ToolOptions{})) {
    for (const char* table : {"", "[bake]\n"}) {
      const std::string text =
          fmt::format("[[scenes]]\nfiles = \"a.glb\"\n{}{} = \"1\"\n", table, option.name);
      const auto plan = planOf(*commandFrom({folder.write("w.toml", text).string()}), libraries);
      ASSERT_FALSE(plan.has_value()) << option.name;
      EXPECT_THAT(plan.error().where, testing::EndsWith(": " + option.name));
      EXPECT_EQ(plan.error().message,
                "belongs on the command line, not into a recipe; leave it out");
      ++refused;
    }
  }
  EXPECT_GT(refused, 12U);
}

/// How the tool runs is in no key of the cache.
TEST(CommandLine, KeepsTheKeysOfJobsWhateverTheRunIsLike) {
  const test::ScratchFolder folder;
  const auto mesh = folder.write("room.glb", "a mesh");
  ASSERT_FALSE(mesh.empty());
  const std::string recipe =
      folder.write("home.toml", "[[scenes]]\nfiles = \"room.glb\"\n").string();
  std::size_t walked = 0;
  for (const auto& options :
       {test::walk(ToolOptions{}), test::walk(ManyPacksOptions{}), test::walk(RecipeCommand{})}) {
    for (const WalkedOption& option : options) {
      // What the recipe would say of its episodes.
      if (option.name == "count" || option.name == "seed") continue;
      SCOPED_TRACE(option.name);
      const auto before = keysOf(parse({recipe}));
      ASSERT_EQ(before.size(), 1U);
      bool is_taken = false;
      for (const std::string& value : test::candidateValues()) {
        const std::string text = option.name == "out" ? "some.pack" : value;
        const Parsed parsed = parse({recipe, fmt::format("--{}={}", option.name, text)});
        if (parsed.isRefused()) continue;
        is_taken = true;
        EXPECT_EQ(keysOf(parsed), before) << text;
      }
      EXPECT_TRUE(is_taken);
      ++walked;
    }
  }
  EXPECT_GE(walked, 12U);
}

}  // namespace
}  // namespace galactic::bake::command_line_test
