// The patterns of a dataset's paths.
#include "dataset/config/dataset_paths.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <regex>
#include <string>
#include <vector>

#include "support/scratch_folder.h"

namespace galactic::test::dataset_paths_test {
namespace {

using bake::matchesPattern;
using bake::matchingPaths;
using testing::ElementsAre;

std::vector<std::string> matches(const ScratchFolder& folder, const std::string& pattern) {
  std::vector<std::string> names;
  const auto found = matchingPaths(folder.path() / "home", pattern);
  EXPECT_TRUE(found);
  for (const auto& path : *found) {
    names.push_back(path.lexically_relative(folder.path()).generic_string());
  }
  return names;
}

/// The same pattern in the language of std::regex.
std::string asRegex(std::string_view pattern) {
  std::string regex;
  for (const char c : pattern) {
    switch (c) {
      case '*':
        regex += "(.|\\n)*";
        break;
      case '?':
        regex += "(.|\\n)";
        break;
      case '.':
        regex += "[.]";
        break;
      case '!':
        regex += '^';
        break;
      default:
        regex += c;
    }
  }
  return regex;
}

TEST(DatasetPaths, PatternsAreThoseOfTheShell) {
  constexpr unsigned kSeed = 4;
  constexpr unsigned kCases = 5'000;
  std::mt19937 random(kSeed);
  const auto text = [&](std::string_view letters, unsigned longest) {
    std::string made;
    for (auto n = random() % (longest + 1); n > 0; --n) {
      made += letters[random() % letters.size()];
    }
    return made;
  };
  const std::vector<std::string> pieces{"*",    "?",    "a",     "b",      ".",
                                        "[ab]", "[!a]", "[a-c]", "[^b-c]", "*"};
  unsigned matched = 0;
  for (unsigned n = 0; n < kCases; ++n) {
    const std::string name = text("abc.", 6);
    std::string pattern;
    for (auto count = 1 + random() % 5; count > 0; --count) {
      pattern += pieces[random() % pieces.size()];
    }
    if (name.empty()) continue;
    const bool hidden = name.front() == '.' && pattern.front() != '.';
    const bool wanted = !hidden && std::regex_match(name, std::regex(asRegex(pattern)));
    EXPECT_EQ(matchesPattern(name, pattern), wanted) << name << " as " << pattern;
    matched += wanted ? 1U : 0U;
  }
  EXPECT_GT(matched, kCases / 10);
  EXPECT_LT(matched, 9 * kCases / 10);
}

TEST(DatasetPaths, HostilePatternsTakeNoTime) {
  std::string pattern;
  for (unsigned n = 0; n < 120; ++n) pattern += "*a";
  EXPECT_FALSE(matchesPattern(std::string(250, 'a'), pattern + "b"));
  EXPECT_TRUE(matchesPattern(std::string(250, 'a'), pattern));
}

TEST(DatasetPaths, FindFilesAndFoldersInsideAndOutside) {
  const ScratchFolder folder;
  for (const char* name : {"home/b/one.json", "home/a/two.json", "home/a/.hidden.json",
                           "home/.c/three.json", "home/a.json", "other/four.json", "home/[x]/y"}) {
    static_cast<void>(folder.write(name, ""));
  }
  EXPECT_THAT(matches(folder, "*"), ElementsAre("home/[x]", "home/a", "home/a.json", "home/b"));
  EXPECT_THAT(matches(folder, "*/"), ElementsAre("home/[x]", "home/a", "home/b"));
  EXPECT_THAT(matches(folder, "./a/"), ElementsAre("home/a"));
  EXPECT_THAT(matches(folder, "?/*.json"), ElementsAre("home/a/two.json", "home/b/one.json"));
  EXPECT_THAT(matches(folder, "../*/four.json"), ElementsAre("other/four.json"));
  EXPECT_THAT(matches(folder, "../other"), ElementsAre("other"));
  EXPECT_THAT(matches(folder, ".c/*"), ElementsAre("home/.c/three.json"));
  EXPECT_THAT(matches(folder, "a.json/*"), ElementsAre());
  EXPECT_THAT(matches(folder, "../../nowhere/*"), ElementsAre());
  EXPECT_THAT(matches(folder, (folder.path() / "other/*").string()),
              ElementsAre("other/four.json"));
  EXPECT_THAT(matches(folder, "[[]x]"), ElementsAre("home/[x]"));
}

}  // namespace
}  // namespace galactic::test::dataset_paths_test
