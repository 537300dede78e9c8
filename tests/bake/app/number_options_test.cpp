// Every option that is a number, with everything that is none.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "options.h"

namespace galactic::bake::number_options_test {
namespace {

using Texts = std::vector<std::string>;
using testing::HasSubstr;

const Texts kScene{"room.glb"};
const Texts kObject{"--as", "object", "mug.glb"};
const Texts kGenerate{"--as", "episodes", "home.pack"};
const Texts kDataset{"home.scene_dataset_config.json"};

/// Options that take numbers, and what they go with.
const std::map<std::string, Texts>& numberOptions() {
  static const std::map<std::string, Texts> options{
      {"--jobs", kScene},
      {"--radii", kScene},
      {"--seed", kGenerate},
      {"--spacing", kScene},
      {"--keep-components", kScene},
      {"--check-columns", kScene},
      {"--scale", kScene},
      {"--transform", kScene},
      {"--eps", kObject},
      {"--tau", kObject},
      {"--max-spheres", kObject},
      {"--render-error", kScene},
      {"--texture-size", kScene},
      {"--count", kGenerate},
      {"--objects", kGenerate},
      {"--heights", kGenerate},
      {"--flatness", kGenerate},
      {"--goal-distance", kGenerate},
      {"--start-distance", kGenerate},
      {"--most-skipped", kGenerate},
      {"--solve", kGenerate},
      {"--memory", kDataset},
      {"--shard", kDataset},
      {"--tolerance", {"room.glb", "--check", "golden.json"}},
      {"--held-out", {"--as", "episodes", "--split", "train", "home.pack"}},
      {"--split-seed", {"--as", "episodes", "--split", "train", "home.pack"}}};
  return options;
}

Result<BakeCommand> commandWith(Texts arguments, const std::string& option) {
  arguments.push_back(option);
  return commandFrom(arguments);
}

TEST(NumberOptions, RefuseWhatIsNoNumber) {
  for (const auto& [option, with] : numberOptions()) {
    ASSERT_TRUE(commandFrom(with).has_value()) << option;
    for (const char* value : {"nan", "-nan", "inf", "-inf", "1e999", "abc", "", " ", "1,,2", ",1",
                              "1,", "-1,", "99999999999999999999999", "--1", "1 2", "0x10"}) {
      const auto command = commandWith(with, option + "=" + value);
      EXPECT_FALSE(command.has_value()) << option << "=" << value;
    }
    // Twice the same is a mistake, or a list of two.
    if (option == "--radii" || option == "--texture-size") continue;
    Texts twice = with;
    twice.insert(twice.end(), {option + "=1", option + "=1"});
    EXPECT_FALSE(commandFrom(twice).has_value()) << option;
  }
}

TEST(NumberOptions, RefuseNegativeWholeNumbersAndOctalOnes) {
  for (const char* option : {"--jobs", "--keep-components", "--check-columns", "--max-spheres",
                             "--texture-size", "--count", "--solve", "--split-seed", "--seed"}) {
    for (const char* value : {"-1", "-0", "010", "1.0", "1e2", "+1"}) {
      const auto command =
          commandWith(numberOptions().at(option), std::string(option) + "=" + value);
      EXPECT_FALSE(command.has_value()) << option << "=" << value;
    }
  }
}

TEST(Options, RefuseWhatWouldBeIgnored) {
  struct Pair {
    Texts arguments;
    std::string where;
    std::string message;
  };
  for (const Pair& pair : std::vector<Pair>{
           {{"room.glb", "--seed", "0,1,0", "--keep-components", "2"},
            "--keep-components",
            "does not go with --seed"},
           {{"room.glb", "--keep", "all", "--seed", "0,1,0"}, "--seed", "--keep all stores"},
           {{"room.glb", "--keep", "all", "--keep-components", "2"},
            "--keep-components",
            "--keep all stores"},
           {{"room.glb", "--tolerance", "0.1"}, "--tolerance", "is about --check"},
           {{"room.glb", "--no-render-meshes", "--texture-size", "64"},
            "--texture-size",
            "does not go with --no-render-meshes"},
           {{"robot.urdf", "--obb", "min"}, "--obb", "is about objects"},
           {{"robot.urdf", "--no-support"}, "--no-support", "is about objects"},
           {{"--as", "world", "a.pack", "b.pack", "--shard", "1/2"}, "--shard", "not with packs"},
           {{"--as", "world", "a.pack", "--memory", "2"}, "--memory", "not with packs"},
           {{"home.scene_dataset_config.json", "--data", "dir"}, "--data", "not with a dataset"},
           {{"--as", "episodes", "a.pack", "--held-out", "0.1"}, "--held-out", "is about --split"},
           {{"--as", "episodes", "a.pack", "--split-seed", "3"},
            "--split-seed",
            "is about --split"},
           {{"home.scene_dataset_config.json", "--seed", "0,1,0"}, "--seed", "has many"},
           {{"room.glb", "--scale", ""}, "--scale", "has an empty value"},
           {{"room.glb", "--report", ""}, "--report", "has an empty value"},
           {{"home.episode_set.json", "--start-joints", "a,,b"},
            "--start-joints",
            "has an empty name"}}) {
    const auto command = commandFrom(pair.arguments);
    ASSERT_FALSE(command.has_value()) << pair.message;
    EXPECT_EQ(command.error().where, pair.where);
    EXPECT_THAT(command.error().message, HasSubstr(pair.message));
  }
}

TEST(Options, SuggestTheNearestOption) {
  const auto command = commandFrom({"room.glb", "--radi", "0.1"});
  ASSERT_FALSE(command.has_value());
  EXPECT_THAT(command.error().message, HasSubstr("did you mean '--radii'?"));
}

}  // namespace
}  // namespace galactic::bake::number_options_test
