#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>

#include "pack_tool/describe/info_text.h"
#include "pack_tool/describe/pack_description.h"
#include "pack_tool/support/console.h"
#include "pack_tool/support/text_table.h"
#include "support/pack_tool_fixture.h"

namespace galactic::pack_tool::description_test {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr unsigned kSeed = 20230608;

TEST(JsonNumber, ReadsBackToTheSameFloat) {
  std::mt19937 random(kSeed);
  std::uniform_int_distribution<std::uint32_t> bits;
  int finite = 0;
  constexpr int kCases = 20000;
  for (int n = 0; n < kCases; ++n) {
    const auto value = std::bit_cast<float>(bits(random));
    const Json json = Json::parse(jsonText(jsonNumber(value)));
    if (!std::isfinite(value)) {
      EXPECT_TRUE(json.is_null());
      continue;
    }
    ++finite;
    ASSERT_EQ(static_cast<float>(json.get<double>()), value) << "seed " << kSeed;
  }
  EXPECT_GT(finite, kCases * 9 / 10);
}

TEST(JsonNumber, IsAsShortAsUsersTypeIt) {
  EXPECT_EQ(jsonText(jsonNumber(0.015F)), "0.015\n");
  EXPECT_EQ(jsonText(jsonNumber(-3.75F)), "-3.75\n");
}

TEST(JsonText, ReplacesBytesThatAreNoUtf8) {
  EXPECT_EQ(jsonText(Json("a\xff")), "\"a\xef\xbf\xbd\"\n");
}

TEST(Printable, KeepsNamesFromSteeringTheTerminal) {
  EXPECT_EQ(printable("a\x1b[31mb\n\x7f"), "a?[31mb??");
  EXPECT_EQ(printable("k\xc3\xbc"
                      "che"),
            "k\xc3\xbc"
            "che");
}

TEST(Grouped, PutsCommasBetweenThousands) {
  EXPECT_EQ(grouped(0), "0");
  EXPECT_EQ(grouped(999), "999");
  EXPECT_EQ(grouped(1000), "1,000");
  EXPECT_EQ(grouped(1234567), "1,234,567");
}

TEST(TextTable, LinesUpItsColumnsAndLeavesNoBlanksAtTheEnd) {
  TextTable table(1);
  table.add({"a", "1", "22"});
  table.add({"long", "333", ""});
  EXPECT_EQ(table.text(), " a       1  22\n long  333\n");
}

TEST(WorseExit, PrefersInternalAndInvalidInputOverUnreadable) {
  const int io = static_cast<int>(ErrorCode::kIo);
  const int invalid = static_cast<int>(ErrorCode::kInvalidInput);
  const int internal = static_cast<int>(ErrorCode::kInternal);
  const int unsupported = static_cast<int>(ErrorCode::kUnsupported);
  EXPECT_EQ(worseExit(kExitOk, unsupported), unsupported);
  EXPECT_EQ(worseExit(unsupported, io), io);
  EXPECT_EQ(worseExit(invalid, io), invalid);
  EXPECT_EQ(worseExit(internal, invalid), internal);
  EXPECT_EQ(worseExit(kExitOk, kExitOk), kExitOk);
}

/// Descriptions of a pack made of these fields.
Json describe(const test::ScenePackFields& fields) {
  const auto bytes = test::buildPack(fields);
  const auto pack = PackFile::view(bytes.bytes(), "kitchen.pack");
  if (!pack) {
    ADD_FAILURE() << pack.error().text();
    return {};
  }
  return describePack(*pack);
}

TEST(DescribePack, TellsWhatTheCellsHold) {
  const Json json = describe(test::kitchenScene());
  ASSERT_EQ(json.at("scene").at("column_grids").size(), 2U);
  const Json& grid = json.at("scene").at("column_grids").at(0);
  const Json& content = grid.at("content");
  EXPECT_EQ(content.at("cells"), 15);
  EXPECT_EQ(content.at("free_columns"), 5);
  EXPECT_EQ(content.at("spans"), 11);
  EXPECT_EQ(content.at("max_spans"), 4);
  EXPECT_EQ(content.at("overflow_cells"), 2);
  EXPECT_EQ(content.at("spans_per_free_column"), 2.2);
  EXPECT_EQ(grid.at("statistics").at("regions").at(1).at("region"), "outside");
  EXPECT_EQ(grid.at("statistics").at("cast_check").at("errors"), 0.0);
}

TEST(DescribePack, WritesSourceHashesHighHalfFirst) {
  const Json json = describe(test::kitchenScene());
  EXPECT_EQ(json.at("provenance").at("sources").at(0).at("xxh3_128"),
            "00000000000000020000000000000001");
}

TEST(DescribePack, KeepsTheOrderOfItsKeys) {
  const Json json = describe(test::kitchenScene());
  std::vector<std::string> keys;
  for (const auto& [key, value] : json.items()) keys.push_back(key);
  EXPECT_THAT(keys, testing::ElementsAre("file", "kind", "format_version", "bytes", "payload_xxh64",
                                         "provenance", "scene", "render_meshes"));
}

TEST(InfoText, HasOneTableColumnPerGrid) {
  const std::string text = infoText(describe(test::kitchenScene()));
  EXPECT_THAT(text, HasSubstr("kitchen.pack\n  kind         SCEN, format version 1\n"));
  EXPECT_THAT(text, testing::ContainsRegex("\n    radius \\(m\\) +0.5 +0.75\n"));
  EXPECT_THAT(text, testing::ContainsRegex("\n    spans +11 +3\n"));
  EXPECT_THAT(text, testing::ContainsRegex("\n    casts: errors \\(m\\) +0 +0\n"));
  EXPECT_THAT(text, HasSubstr("warnings     texture wood.png is missing\n"));
}

TEST(InfoText, ShowsADashWhereTheCastCheckWasSwitchedOff) {
  test::ScenePackFields fields = test::kitchenScene();
  fields.grids.at(1).cast_check.reset();
  EXPECT_THAT(infoText(describe(fields)), testing::ContainsRegex("\n    casts: columns +8 +-\n"));
}

TEST(InfoText, StripsControlCharactersFromNames) {
  test::ScenePackFields fields = test::kitchenScene();
  fields.warning = "evil \x1b[2J name";
  EXPECT_THAT(infoText(describe(fields)), Not(HasSubstr("\x1b")));
}

}  // namespace
}  // namespace galactic::pack_tool::description_test
