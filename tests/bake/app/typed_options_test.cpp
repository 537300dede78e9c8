// What a command remembers of its options, for the key of the cache.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>
#include <set>
#include <string>
#include <vector>

#include "options.h"

namespace galactic::bake::typed_options_test {
namespace {

using Texts = std::vector<std::string>;

/// Which packs are made, where and how fast; or files, which count by their content.
const std::set<std::string> kNotContent{
    "--help",    "--as",         "--out",        "--jobs",        "--report",  "--check",
    "--config",  "--dry-run",    "--keep-going", "--verbose",     "--quiet",   "--print-recipe",
    "--version", "--tolerance",  "--scenes",     "--missing",     "--list",    "--data",
    "--cache",   "--no-cache",   "--shard",      "--memory",      "--recipe",  "--spheres",
    "--package", "--collection", "--only",       "--object-pack", "--geometry"};

/// An option that decides what a pack or its report says, with two values.
struct ContentOption {
  std::string name;
  /// Arguments with which it makes sense.
  Texts with;
  /// Empty: a switch.
  std::string value;
  std::string other;
};

const Texts kScene{"room.glb"};
const Texts kObject{"--as", "object", "mug.glb"};
const Texts kImport{"home.episode_set.json"};
const Texts kGenerate{"--as", "episodes", "home.pack"};
const Texts kSplit{"--as", "episodes", "--split", "train", "home.pack"};

const std::vector<ContentOption>& contentOptions() {
  static const std::vector<ContentOption> options{
      {"--radii", kScene, "0.05", "0.12"},
      {"--seed", kScene, "0,1,0", "0,1,1"},
      {"--seed", kGenerate, "1", "2"},
      {"--spacing", kScene, "0.03", "0.02"},
      {"--coverage", kScene, "column", "cell"},
      {"--engine", kScene, "exact", "embree"},
      {"--keep", kScene, "room", "all"},
      {"--keep-components", kScene, "1", "2"},
      {"--check-columns", kScene, "0", "9"},
      {"--up", kScene, "y", "z"},
      {"--scale", kScene, "1", "0.01"},
      {"--transform", kScene, "1,0,0,0,0,1,0,0,0,0,1,0", "1,0,0,1,0,1,0,0,0,0,1,0"},
      {"--obb", kObject, "yaw", "min"},
      {"--profile", kObject, "object", "tight"},
      {"--eps", kObject, "0.01", "0.02"},
      {"--tau", kObject, "0.02", "0.03"},
      {"--max-spheres", kObject, "9", "8"},
      {"--no-support", kObject, "", ""},
      {"--allow-missing", {"robot.urdf"}, "", ""},
      {"--allow-outside", kScene, "", ""},
      {"--no-render-meshes", kScene, "", ""},
      {"--render-error", kScene, "0.01", "0.02"},
      {"--texture-size", kScene, "256", "128"},
      {"--texture-format", kScene, "rgba8", "bc1"},
      {"--lighting", kScene, "none", "all"},
      {"--scene-name", kImport, "a=b", "a=c"},
      {"--start-joints", kImport, "a,b", "b,a"},
      {"--object-up", kImport, "y", "z"},
      {"--targets", kImport, "first", "each"},
      {"--count", kGenerate, "7", "8"},
      {"--objects", kGenerate, "2", "2,3"},
      {"--heights", kGenerate, "0.3,1", "0.3,1.1"},
      {"--flatness", kGenerate, "0.004", "0.01"},
      {"--goal-distance", kGenerate, "1", "1,2"},
      {"--start-distance", kGenerate, "1", "1,2"},
      {"--most-skipped", kGenerate, "0.2", "0.3"},
      {"--goal-elsewhere", kGenerate, "", ""},
      {"--supports", kGenerate, "found", "both"},
      {"--split", kGenerate, "train", "validation"},
      {"--held-out", kSplit, "0.2", "0.3"},
      {"--split-seed", kSplit, "1", "2"},
      {"--solve", kGenerate, "0", "3"}};
  return options;
}

/// All long options of --help.
std::set<std::string> optionsOfHelp() {
  testing::internal::CaptureStdout();
  const char* const arguments[] = {"galactic-bake", "--help"};
  const ParsedCommand parsed = parseCommandLine(2, arguments);
  std::fflush(stdout);
  const std::string help = testing::internal::GetCapturedStdout();
  EXPECT_EQ(std::get<int>(parsed), 0);
  std::set<std::string> options;
  const std::regex option(R"((?:^|\n)\s+(?:-\w,)?(--[a-z-]+))");
  for (std::sregex_iterator at(help.begin(), help.end(), option), end; at != end; ++at) {
    options.insert((*at)[1]);
  }
  return options;
}

Result<BakeCommand> commandWith(const ContentOption& option, const std::string& value) {
  Texts arguments = option.with;
  arguments.push_back(value.empty() ? option.name : option.name + "=" + value);
  return commandFrom(arguments);
}

TEST(TypedOptions, HoldEveryOptionThatDecidesContent) {
  std::set<std::string> seen = kNotContent;
  for (const ContentOption& option : contentOptions()) {
    SCOPED_TRACE(option.name);
    seen.insert(option.name);
    const auto without = commandFrom(option.with);
    ASSERT_TRUE(without.has_value()) << without.error().message;
    EXPECT_EQ(without->typed_options.empty(), option.with != kSplit);
    const auto one = commandWith(option, option.value);
    ASSERT_TRUE(one.has_value()) << one.error().where << ": " << one.error().message;
    EXPECT_NE(one->typed_options, without->typed_options);
    if (option.value.empty()) continue;
    const auto other = commandWith(option, option.other);
    ASSERT_TRUE(other.has_value()) << other.error().where << ": " << other.error().message;
    EXPECT_NE(one->typed_options, other->typed_options);
  }
  const std::set<std::string> all = optionsOfHelp();
  EXPECT_GT(all.size(), 60U);
  EXPECT_EQ(seen, all) << "a new option belongs into one of the two lists above";
}

TEST(TypedOptions, DoNotHoldFilesNorHowTheWorkIsDone) {
  const auto command = commandFrom({"robot.urdf", "--recipe", "robot.toml", "--package", "p=dir",
                                    "--jobs", "3", "--report", "report.json"});
  ASSERT_TRUE(command.has_value()) << command.error().message;
  EXPECT_THAT(command->typed_options, testing::IsEmpty());
}

}  // namespace
}  // namespace galactic::bake::typed_options_test
