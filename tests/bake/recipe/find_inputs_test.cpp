// Patterns of names, against all ways to match them, and the files that they find.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "recipe/world_recipe.h"
#include "support/scratch_folder.h"

namespace galactic::test::find_inputs_test {
namespace {

namespace fs = std::filesystem;
using bake::findInputs;
using bake::fitsPattern;
using testing::ElementsAre;

/// All ways: a star takes nothing, or one character and stays.
bool fitsSomehow(std::string_view text, std::string_view pattern) {
  if (pattern.empty()) return text.empty();
  if (pattern.front() == '*') {
    return fitsSomehow(text, pattern.substr(1)) ||
           (!text.empty() && fitsSomehow(text.substr(1), pattern));
  }
  return !text.empty() && (pattern.front() == '?' || pattern.front() == text.front()) &&
         fitsSomehow(text.substr(1), pattern.substr(1));
}

std::string randomText(std::mt19937& random, std::string_view letters, std::size_t longest) {
  std::string text(random() % (longest + 1), ' ');
  for (char& letter : text) letter = letters[random() % letters.size()];
  return text;
}

TEST(FitsPattern, AgreesWithAllWaysToMatch) {
  constexpr unsigned kSeed = 20;
  constexpr int kCases = 100'000;
  std::mt19937 random(kSeed);
  int fitting = 0;
  for (int n = 0; n < kCases; ++n) {
    const std::string text = randomText(random, "ab", 6);
    const std::string pattern = randomText(random, "ab?**", 5);
    const bool fits = fitsSomehow(text, pattern);
    fitting += fits ? 1 : 0;
    ASSERT_EQ(fitsPattern(text, pattern), fits) << text << " " << pattern << " seed " << kSeed;
  }
  EXPECT_GT(fitting, kCases / 10);
  EXPECT_LT(fitting, kCases * 9 / 10);
}

TEST(FitsPattern, TakesBoundedTimeForManyStars) {
  const std::string text(2000, 'a');
  std::string pattern;
  for (int n = 0; n < 50; ++n) pattern += "*a";
  EXPECT_TRUE(fitsPattern(text, pattern));
  EXPECT_FALSE(fitsPattern(text, pattern + "b"));
}

/// Two folders of files; the second is where --data points to.
class FindInputs : public testing::Test {
 protected:
  void SetUp() override {
    for (const char* name : {"own/a.glb", "own/b.glb", "own/.c.glb", "own/in/d.glb", "own/in/e.obj",
                             "data/a.glb", "data/far/f.glb", "data/near/f.glb"}) {
      static_cast<void>(folder_.write(name, "x"));
    }
  }
  [[nodiscard]] fs::path at(const std::string& name) const { return folder_.path() / name; }
  [[nodiscard]] std::vector<std::string> found(const std::vector<std::string>& patterns) const {
    const auto inputs = findInputs(patterns, {at("own"), at("data")});
    if (!inputs) return {"error: " + inputs.error().where};
    std::vector<std::string> names;
    for (const fs::path& input : *inputs) {
      names.push_back(input.lexically_relative(folder_.path()).generic_string());
    }
    return names;
  }
  ScratchFolder folder_;
};

TEST_F(FindInputs, TakesTheFirstRootWhereAPatternFits) {
  EXPECT_THAT(found({"a.glb"}), ElementsAre("own/a.glb"));
  EXPECT_THAT(found({"far/f.glb"}), ElementsAre("data/far/f.glb"));
  EXPECT_THAT(found({"*/f.glb"}), ElementsAre("data/far/f.glb", "data/near/f.glb"));
  EXPECT_THAT(found({"*/?.glb"}), ElementsAre("own/in/d.glb"));
}

TEST_F(FindInputs, DeliversEachFileOnceAndAscending) {
  EXPECT_THAT(found({"b.glb", "?.glb", "a.*"}), ElementsAre("own/a.glb", "own/b.glb"));
  EXPECT_THAT(found({"in"}), ElementsAre("own/in"));
  EXPECT_THAT(found({"in/"}), ElementsAre("own/in"));
  EXPECT_THAT(found({}), testing::IsEmpty());
}

TEST_F(FindInputs, FindsHiddenFilesOnlyByAWrittenDot) {
  EXPECT_THAT(found({"*.glb"}), ElementsAre("own/a.glb", "own/b.glb"));
  EXPECT_THAT(found({".*.glb"}), ElementsAre("own/.c.glb"));
}

TEST_F(FindInputs, TakesAbsolutePatterns) {
  EXPECT_THAT(found({at("data/*/f.glb").string()}),
              ElementsAre("data/far/f.glb", "data/near/f.glb"));
}

TEST_F(FindInputs, DoesNotTakeAnEmptyFolderForOneThatIsElsewhere) {
  std::filesystem::create_directories(at("own/near"));
  EXPECT_THAT(found({"near"}), ElementsAre("data/near"));
  // Where there is no other, its reader says what it misses in it.
  std::filesystem::create_directories(at("own/void"));
  EXPECT_THAT(found({"void"}), ElementsAre("own/void"));
}

TEST_F(FindInputs, NamesThePatternThatFitsNothingAndWhereItLooked) {
  const auto inputs = findInputs({"a.glb", "z*.glb"}, {at("own"), at("data")});
  ASSERT_FALSE(inputs.has_value());
  EXPECT_EQ(inputs.error().code, ErrorCode::kIo);
  EXPECT_EQ(inputs.error().where, "z*.glb");
  EXPECT_EQ(inputs.error().message,
            fmt::format("fits no file in {} or {}; correct it, or tell with `data` where the files "
                        "are",
                        at("own").string(), at("data").string()));
}

}  // namespace
}  // namespace galactic::test::find_inputs_test
