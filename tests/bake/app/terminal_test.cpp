// Warnings of one kind are grouped where they are printed, and places of errors have flags.
#include "terminal.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <vector>

namespace galactic::test::terminal_test {
namespace {

using bake::Verbosity;
using bake::warningLines;
using testing::ElementsAre;
using testing::ElementsAreArray;

std::vector<std::string> manyOfAKind(int count) {
  std::vector<std::string> warnings;
  for (int n = 0; n < count; ++n) {
    warnings.push_back(
        fmt::format("link 'l{}' visual {}: the robot's mesh 'm {}.stl' is missing", n, n % 3, n));
  }
  return warnings;
}

TEST(WarningLines, OfManyOfAKindAreTheFirstAndACount) {
  std::vector<std::string> warnings = manyOfAKind(43);
  warnings.insert(warnings.begin() + 5, "joint 'j': its limits are both 0, so it cannot move");
  EXPECT_THAT(warningLines(warnings, Verbosity::kNormal),
              ElementsAre("link 'l0' visual 0: the robot's mesh 'm 0.stl' is missing (and 42 more "
                          "of this kind; -v lists them)",
                          "joint 'j': its limits are both 0, so it cannot move"));
  EXPECT_THAT(warningLines(warnings, Verbosity::kVerbose), ElementsAreArray(warnings));
}

TEST(WarningLines, OfAFewAreAllOfThem) {
  EXPECT_THAT(warningLines(manyOfAKind(3), Verbosity::kNormal), ElementsAreArray(manyOfAKind(3)));
  EXPECT_EQ(warningLines(manyOfAKind(4), Verbosity::kNormal).size(), 1U);
}

TEST(WarningLines, ThatDifferInAWordStaySingle) {
  const std::vector<std::string> warnings{"link 'a': it is red", "link 'a': it is blue",
                                          "link 'a': it is gray", "link 'a': it's gone",
                                          "link 'a: it is cut off"};
  EXPECT_THAT(warningLines(warnings, Verbosity::kNormal), ElementsAreArray(warnings));
  EXPECT_TRUE(warningLines({}, Verbosity::kNormal).empty());
}

TEST(Places, OfErrorsHaveFlags) {
  const auto placeOf = [](std::string where) {
    return bake::placeOf(
        {.code = ErrorCode::kInvalidInput, .where = std::move(where), .message = {}});
  };
  EXPECT_EQ(placeOf("home.glb: `spacing`"), "home.glb: --spacing");
  EXPECT_EQ(placeOf("`spacing`"), "--spacing");
  EXPECT_EQ(placeOf("scenes"), "--scenes");
  EXPECT_EQ(placeOf("world.toml:7: spacing"), "world.toml:7: spacing") << "as the recipe says it";
  EXPECT_EQ(placeOf("it`s.glb: `hall`"), "it`s.glb: `hall`");
}

}  // namespace
}  // namespace galactic::test::terminal_test
