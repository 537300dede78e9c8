#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "pack_tool/describe/pack_description.h"
#include "pack_tool/mesh/grid_view.h"
#include "pack_tool/verbs/verbs.h"
#include "support/pack_tool_fixture.h"

namespace galactic::pack_tool::column_test {
namespace {

using test::GridBuilder;
using test::GridSpec;
using testing::HasSubstr;

/// What a verb printed and returned.
struct Outcome {
  int exit_code = 0;
  std::string out;
  std::string err;
};

Outcome askColumn(const ColumnOptions& options) {
  std::ostringstream out;
  std::ostringstream err;
  const int exit_code = runColumn(options, Console{out, err});
  return {exit_code, out.str(), err.str()};
}

TEST(ColumnVerb, PrintsSpansCellAndSurfacesOfEveryGrid) {
  const test::ScratchFolder folder;
  const auto pack = test::writePack(folder, "a.pack", test::kitchenScene());
  const Outcome outcome = askColumn({.pack = pack, .at = {1.75, 0.25}});
  EXPECT_EQ(outcome.exit_code, kExitOk) << outcome.err;
  EXPECT_EQ(outcome.out,
            "radius 0.5 m: cell (1, 0), column at x 1.5, z 0.5\n"
            "  span  center from  center to  height  surface below  surface above\n"
            "  0          1.0000     2.0000  1.0000         0.5000         2.5000\n"
            "  1          3.0000     4.0000  1.0000         2.5000         4.5000\n"
            "radius 0.75 m: cell (1, 0), column at x 1.5, z 0.5: blocked at all heights\n");
}

TEST(ColumnVerb, PrintsOverflowCellsCompletelyAsJson) {
  const test::ScratchFolder folder;
  const auto pack = test::writePack(folder, "a.pack", test::kitchenScene());
  const Outcome outcome =
      askColumn({.pack = pack, .at = {3.5, 2.5}, .radius = 0.5F, .form = OutputForm::kJson});
  ASSERT_EQ(outcome.exit_code, kExitOk) << outcome.err;
  const Json json = Json::parse(outcome.out);
  ASSERT_EQ(json.at("columns").size(), 1U);
  const Json& column = json.at("columns").at(0);
  EXPECT_EQ(column.at("cell"), Json::parse("[3, 2]"));
  ASSERT_EQ(column.at("spans").size(), 4U);
  EXPECT_EQ(column.at("spans").at(3).at("lo"), 3.5);
  EXPECT_EQ(column.at("spans").at(3).at("surface_above"), 4.5);
}

TEST(ColumnVerb, RefusesAPointOutsideAllGridsAndNamesTheRange) {
  const test::ScratchFolder folder;
  const auto pack = test::writePack(folder, "a.pack", test::kitchenScene());
  const Outcome outcome = askColumn({.pack = pack, .at = {7, 1}});
  EXPECT_EQ(outcome.exit_code, static_cast<int>(ErrorCode::kInvalidInput));
  EXPECT_EQ(outcome.out, "");
  EXPECT_THAT(outcome.err, HasSubstr("x 7, z 1 is outside"));
  EXPECT_THAT(outcome.err, HasSubstr("x in [0.0000, 5.0000) and z in [0.0000, 3.0000)"));
}

TEST(ColumnVerb, SaysSoWhereOnlyAPaddedGridReaches) {
  test::ScenePackFields fields;
  fields.grids.emplace_back(GridBuilder(GridSpec{}).column(4, 0, {{1, 2}}).build());
  fields.grids.emplace_back(
      GridBuilder(GridSpec{.radius = 0.75F, .columns_x = 6}).column(5, 0, {{1, 2}}).build());
  const test::ScratchFolder folder;
  const auto pack = test::writePack(folder, "a.pack", fields);
  const Outcome outcome = askColumn({.pack = pack, .at = {5.5, 0.5}});
  EXPECT_EQ(outcome.exit_code, kExitOk) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("radius 0.5 m: outside this grid\n"));
  EXPECT_THAT(outcome.out, HasSubstr("radius 0.75 m: cell (5, 0)"));
}

TEST(ColumnVerb, NamesTheRadiiThereAreForAnotherRadius) {
  const test::ScratchFolder folder;
  const auto pack = test::writePack(folder, "a.pack", test::kitchenScene());
  const Outcome outcome = askColumn({.pack = pack, .at = {1, 1}, .radius = 0.2F});
  EXPECT_EQ(outcome.exit_code, static_cast<int>(ErrorCode::kInvalidInput));
  EXPECT_THAT(outcome.err, HasSubstr("has no grid of radius 0.2 m; its radii are 0.5, 0.75"));
}

}  // namespace
}  // namespace galactic::pack_tool::column_test
