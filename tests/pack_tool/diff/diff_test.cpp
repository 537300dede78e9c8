#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "pack_tool/diff/grid_diff.h"
#include "pack_tool/verbs/verbs.h"
#include "support/pack_tool_fixture.h"
#include "support/packs/world_pack_builder.h"

namespace galactic::pack_tool::diff_test {
namespace {

using test::GridBuilder;
using test::GridSpec;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr unsigned kSeed = 20230609;
/// Sums of exact eighths of meters: only the last bit may differ.
constexpr double kSumTolerance = 1e-12;

GridBuilder threeColumns() {
  return GridBuilder(GridSpec{})
      .column(0, 0, {{1, 2}})
      .column(1, 1, {{1, 2}, {3, 4}})
      .column(4, 2, {{0, 8}});
}

TEST(CompareGrids, FindsEqualGridsEqual) {
  const auto a = threeColumns().build();
  const auto b = threeColumns().build();
  const GridDifference difference = compareGrids(a.view(), b.view(), 0);
  EXPECT_FALSE(difference.differs());
  EXPECT_EQ(difference.columns, 15U);
  EXPECT_EQ(difference.free_only_in_a, 0);
  EXPECT_THAT(difference.worst, IsEmpty());
}

TEST(CompareGrids, MeasuresAMovedEnd) {
  const auto a = threeColumns().build();
  const auto b =
      threeColumns().column(1, 1, {{1, 2}, {3, 4.5F}}).column(0, 0, {{1.25F, 2}}).build();
  const GridDifference difference = compareGrids(a.view(), b.view(), 0);
  EXPECT_TRUE(difference.differs());
  EXPECT_EQ(difference.count_differs, 0U);
  EXPECT_EQ(difference.ends_differ, 2U);
  EXPECT_EQ(difference.ends, 2U);
  EXPECT_EQ(difference.largest_end, 0.5);
  EXPECT_EQ(difference.mean_end, 0.375);
  EXPECT_NEAR(difference.free_only_in_a, 0.25, kSumTolerance);
  EXPECT_NEAR(difference.free_only_in_b, 0.5, kSumTolerance);
  ASSERT_EQ(difference.worst.size(), 2U);
  EXPECT_EQ(difference.worst.front().cell, (ColumnIndex{1, 1}));
  EXPECT_EQ(difference.worst.front().height, 0.5);
  EXPECT_EQ(difference.worst.front().center.x, 1.5);
}

TEST(CompareGrids, CountsAMissingSpan) {
  const auto a = threeColumns().build();
  const auto b = threeColumns().column(1, 1, {{3, 4}}).build();
  const GridDifference difference = compareGrids(a.view(), b.view(), 10);
  EXPECT_EQ(difference.count_differs, 1U);
  EXPECT_EQ(difference.ends_differ, 0U);
  EXPECT_NEAR(difference.free_only_in_a, 1, kSumTolerance);
  EXPECT_EQ(difference.free_only_in_b, 0);
  ASSERT_EQ(difference.worst.size(), 1U);
  EXPECT_EQ(difference.worst.front().spans_a, 2U);
  EXPECT_EQ(difference.worst.front().spans_b, 1U);
}

TEST(CompareGrids, TakesEndsWithinTheToleranceAsEqual) {
  const auto a = threeColumns().build();
  const auto b = threeColumns().column(4, 2, {{0.125F, 8}}).build();
  EXPECT_FALSE(compareGrids(a.view(), b.view(), 0.125).differs());
  EXPECT_TRUE(compareGrids(a.view(), b.view(), 0.12).differs());
}

TEST(CompareGrids, NamesTheFrameThatDiffersAndComparesNoColumns) {
  const auto a = threeColumns().build();
  const auto b = GridBuilder(GridSpec{.min_x = 0.5F, .columns_x = 6}).build();
  const GridDifference difference = compareGrids(a.view(), b.view(), 0);
  EXPECT_TRUE(difference.differs());
  EXPECT_THAT(difference.frame, ElementsAre(FieldDifference{"min_x", "0", "0.5"},
                                            FieldDifference{"columns_x", "5", "6"}));
  EXPECT_EQ(difference.columns, 0U);
}

TEST(CompareGrids, NamesEachPartOfAFrameThatDiffers) {
  const auto a = GridBuilder(GridSpec{}).build();
  const auto frame_of = [&](const GridSpec& spec) {
    const auto b = GridBuilder(spec).build();
    return compareGrids(a.view(), b.view(), 0).frame;
  };
  EXPECT_THAT(frame_of({.spacing = 0.5F}), ElementsAre(FieldDifference{"spacing", "1", "0.5"}));
  EXPECT_THAT(frame_of({.min_z = 0.5F}), ElementsAre(FieldDifference{"min_z", "0", "0.5"}));
  EXPECT_THAT(frame_of({.heights = {-1, 8}}),
              ElementsAre(FieldDifference{"heights.lo", "0", "-1"}));
  EXPECT_THAT(frame_of({.heights = {0, 9}}), ElementsAre(FieldDifference{"heights.hi", "8", "9"}));
  EXPECT_THAT(frame_of({.columns_z = 5}), ElementsAre(FieldDifference{"columns_z", "3", "5"}));
}

TEST(CompareGrids, KeepsTheFiveWorstColumnsLargestFirst) {
  GridBuilder moved = GridBuilder(GridSpec{});
  GridBuilder original = GridBuilder(GridSpec{});
  for (std::uint32_t i = 0; i < 5; ++i) {
    for (std::uint32_t k = 0; k < 2; ++k) {
      original.column(i, k, {{1, 2}});
      moved.column(i, k, {{1, 2.125F + 0.125F * static_cast<float>(i)}});
    }
  }
  const auto a = original.build();
  const auto b = moved.build();
  const GridDifference difference = compareGrids(a.view(), b.view(), 0);
  EXPECT_EQ(difference.ends_differ, 10U);
  std::vector<ColumnIndex> cells;
  for (const ColumnDifference& column : difference.worst) cells.push_back(column.cell);
  EXPECT_THAT(cells, ElementsAre(ColumnIndex{4, 0}, ColumnIndex{4, 1}, ColumnIndex{3, 0},
                                 ColumnIndex{3, 1}, ColumnIndex{2, 0}));
}

/// Height common to two columns, by counting fine steps.
double countedCommonHeight(const std::vector<Span>& a, const std::vector<Span>& b, double step) {
  const auto holds = [](const std::vector<Span>& spans, double y) {
    return std::any_of(spans.begin(), spans.end(), [y](const Span& span) {
      return y >= static_cast<double>(span.lo) && y <= static_cast<double>(span.hi);
    });
  };
  double height = 0;
  const int steps = static_cast<int>(8 / step);
  for (int n = 0; n < steps; ++n) {
    const double y = (n + 0.5) * step;
    if (holds(a, y) && holds(b, y)) height += step;
  }
  return height;
}

TEST(CommonHeight, AgreesWithCountingFineSteps) {
  std::mt19937 random(kSeed);
  const auto a = test::randomGrid(GridSpec{}, random);
  const auto b = test::randomGrid(GridSpec{}, random);
  constexpr double kStep = 1.0 / 1024;
  // At most one step is missed or added at each of at most 20 ends.
  constexpr double kTolerance = 20 * kStep;
  double free = 0;
  double common = 0;
  for (std::size_t column = 0; column < a.columns.size(); ++column) {
    const double counted = countedCommonHeight(a.columns[column], b.columns[column], kStep);
    ASSERT_NEAR(commonHeight(a.columns[column], b.columns[column]), counted, kTolerance)
        << "seed " << kSeed << " column " << column;
    common += counted;
    free += countedCommonHeight(a.columns[column], a.columns[column], kStep);
  }
  EXPECT_GT(common, 0.1 * free);
  EXPECT_LT(common, 0.9 * free);
}

TEST(CompareFields, TellsListElementsApartByName) {
  const Json a = Json::parse(
      R"({"options": [{"name": "radii", "value": "1"}, {"name": "spacing", "value": "3"}]})");
  const Json b = Json::parse(
      R"({"options": [{"name": "jobs", "value": "8"}, {"name": "spacing", "value": "4"}]})");
  EXPECT_THAT(compareFields(a, b, 0), ElementsAre(FieldDifference{"options.radii", "1", "none"},
                                                  FieldDifference{"options.spacing", "3", "4"},
                                                  FieldDifference{"options.jobs", "none", "8"}));
}

TEST(CompareFields, NumbersRepeatedNames) {
  const Json a = Json::parse(R"([{"name": "seed", "value": "1"}, {"name": "seed", "value": "2"}])");
  const Json b = Json::parse(R"([{"name": "seed", "value": "1"}, {"name": "seed", "value": "3"}])");
  EXPECT_THAT(compareFields(a, b, 0), ElementsAre(FieldDifference{"seed#2", "2", "3"}));
}

/// What galactic-bake writes of a world: a scene, which has no name, and two objects of one pack.
Json worldReport() {
  return Json::parse(R"({
    "jobs": [{"pack": "objects.pack", "as": "object"}, {"pack": "scenes/a.pack", "as": "scene"}],
    "baked": [{"pack": "objects.pack", "name": "mug", "spheres": 3},
              {"pack": "objects.pack", "name": "box", "spheres": 4},
              {"pack": "scenes/a.pack", "grids": [{"radius": 0.1, "spans": 5},
                                                  {"radius": 0.2, "spans": 6}]}],
    "left_out": [{"scene": "d", "reasons": ["dark"]}, {"scene": "e", "reasons": ["empty"]}]})");
}

TEST(CompareFields, PairsTheEntriesOfAWorldsReportInAnyOrder) {
  Json other = worldReport();
  for (const char* list : {"jobs", "baked", "left_out"}) {
    std::reverse(other[list].begin(), other[list].end());
  }
  std::reverse(other["baked"][0]["grids"].begin(), other["baked"][0]["grids"].end());
  EXPECT_THAT(compareFields(worldReport(), other, 0), IsEmpty());
}

TEST(CompareFields, TellsWhatAWorldsReportLacksAndNothingElse) {
  Json other = worldReport();
  other["jobs"].erase(0);
  other["baked"].erase(0);
  other["baked"][1]["grids"].erase(0);
  other["left_out"].erase(0);
  EXPECT_THAT(compareFields(worldReport(), other, 0),
              testing::UnorderedElementsAre(
                  FieldDifference{"jobs.objects.pack.as", "object", "none"},
                  FieldDifference{"baked.objects.pack.mug.spheres", "3", "none"},
                  FieldDifference{"baked.scenes/a.pack.grids.0.1.spans", "5", "none"},
                  FieldDifference{"left_out.d.reasons.0", "dark", "none"}));
}

TEST(CompareFields, TakesSpheresByTheirPositions) {
  const Json a = Json::parse(R"([{"radius": 0.1, "x": 1}, {"radius": 0.1, "x": 2}])");
  const Json b = Json::parse(R"([{"radius": 0.1, "x": 1}, {"radius": 0.1, "x": 3}])");
  EXPECT_THAT(compareFields(a, b, 0), ElementsAre(FieldDifference{"1.x", "2", "3"}));
}

TEST(CompareOrder, LooksAtTheNamesThatBothHave) {
  const Json a = Json::parse(R"([{"name": "lift"}, {"name": "swing"}, {"name": "grip"}])");
  const Json more = Json::parse(R"([{"name": "lift"}, {"name": "neck"}, {"name": "grip"}])");
  const Json other = Json::parse(R"([{"name": "grip"}, {"name": "neck"}, {"name": "lift"}])");
  EXPECT_THAT(compareOrder("joints", a, more), IsEmpty());
  EXPECT_THAT(compareOrder("joints", a, other),
              ElementsAre(FieldDifference{"joints.order", "lift, grip", "grip, lift"}));
}

TEST(CompareFields, AppliesTheToleranceToFractionsOnly) {
  const Json a = Json::parse(R"({"length": 1.0, "count": 1})");
  const Json b = Json::parse(R"({"length": 1.25, "count": 2})");
  EXPECT_THAT(compareFields(a, b, 5), ElementsAre(FieldDifference{"count", "1", "2"}));
}

struct Outcome {
  int exit_code = 0;
  std::string out;
};

Outcome diff(const DiffOptions& options) {
  std::ostringstream out;
  std::ostringstream err;
  const int exit_code = runDiff(options, Console{out, err});
  EXPECT_EQ(err.str(), "");
  return {exit_code, out.str()};
}

Outcome diffOf(const test::ScenePackFields& a, const test::ScenePackFields& b,
               DiffOptions options = {}) {
  const test::ScratchFolder folder;
  options.a = test::writePack(folder, "a.pack", a);
  options.b = test::writePack(folder, "b.pack", b);
  return diff(options);
}

TEST(DiffVerb, CallsTheSameBytesIdentical) {
  const Outcome outcome = diffOf(test::kitchenScene(), test::kitchenScene());
  EXPECT_EQ(outcome.exit_code, kExitOk);
  EXPECT_THAT(outcome.out, HasSubstr("\nidentical\n"));
}

TEST(DiffVerb, ReportsProvenanceUnlessOnlyContentCounts) {
  test::ScenePackFields other = test::kitchenScene();
  other.tool_version = "0.2.0";
  other.triangles_read = 101;
  other.triangles_duplicate = 8;
  const Outcome everything = diffOf(test::kitchenScene(), other);
  EXPECT_EQ(everything.exit_code, kExitDiffers);
  EXPECT_THAT(everything.out, HasSubstr("tool_version: 0.1.0 | 0.2.0"));
  EXPECT_THAT(everything.out, HasSubstr("import.triangles_read: 100 | 101"));
  EXPECT_THAT(everything.out, HasSubstr("grid of radius 0.5 m: 15 columns equal"));

  const Outcome content = diffOf(test::kitchenScene(), other, {.scope = DiffScope::kContent});
  EXPECT_EQ(content.exit_code, kExitOk);
  EXPECT_THAT(content.out, HasSubstr("\nequal\n"));
}

TEST(DiffVerb, ReportsBoundsBeyondTheTolerance) {
  test::ScenePackFields other = test::kitchenScene();
  other.bounds_max.x = 5.25F;
  EXPECT_EQ(diffOf(test::kitchenScene(), other, {.tolerance = 0.25}).exit_code, kExitOk);
  const Outcome outcome = diffOf(test::kitchenScene(), other);
  EXPECT_EQ(outcome.exit_code, kExitDiffers);
  EXPECT_THAT(outcome.out, HasSubstr("bounds.max.0: 5.0 | 5.25"));
}

TEST(DiffVerb, PairsGridsByRadius) {
  test::ScenePackFields other = test::kitchenScene();
  other.grids.erase(other.grids.begin());
  const Outcome outcome = diffOf(test::kitchenScene(), other);
  EXPECT_EQ(outcome.exit_code, kExitDiffers);
  EXPECT_THAT(outcome.out, HasSubstr("grid of radius 0.5 m: only in A\n"));
  EXPECT_THAT(outcome.out, HasSubstr("grid of radius 0.75 m: 15 columns equal\n"));
}

TEST(DiffVerb, ReportsAnotherCoverage) {
  test::ScenePackFields other = test::kitchenScene();
  other.grids.front().coverage = 1;
  const Outcome outcome = diffOf(test::kitchenScene(), other);
  EXPECT_EQ(outcome.exit_code, kExitDiffers);
  EXPECT_THAT(outcome.out, HasSubstr("grid(0.5).coverage: column | cell"));
}

TEST(DiffVerb, PrintsTheMostDifferentColumnsAsTextAndJson) {
  test::ScenePackFields other = test::kitchenScene();
  GridBuilder builder(GridSpec{});
  for (std::uint32_t k = 0; k < 3; ++k) {
    for (std::uint32_t i = 0; i < 5; ++i) {
      builder.column(i, k, other.grids.front().grid.columns[std::size_t{k} * 5 + i]);
    }
  }
  other.grids.front() = test::GridFields(builder.column(4, 2, {{0, 7}}).build());
  const Outcome text = diffOf(test::kitchenScene(), other);
  EXPECT_EQ(text.exit_code, kExitDiffers);
  EXPECT_THAT(text.out,
              testing::ContainsRegex("4\\.5000  2\\.5000  \\(4, 2\\) +1 +1 +1\\.000000\n"));

  const Outcome json_outcome = diffOf(test::kitchenScene(), other, {.form = OutputForm::kJson});
  const Json json = Json::parse(json_outcome.out);
  EXPECT_EQ(json.at("differs"), true);
  EXPECT_EQ(json.at("grids").at(0).at("worst").at(0).at("cell"), Json::parse("[4, 2]"));
  EXPECT_EQ(json.at("grids").at(0).at("free_only_in_a"), 1.0);
  EXPECT_EQ(json.at("grids").at(1).at("differs"), false);
}

TEST(DiffVerb, PairsThePacksOfAWorldThatWasRenamedAndTellsOfEachOnce) {
  const test::ScratchFolder folder;
  const auto worldOf = [&](const std::string& file, const std::string& name, std::uint64_t hash) {
    test::WorldPackFields fields;
    fields.packs = {{.path = name + "/objects/mug.pack", .kind = "OBJS"},
                    {.path = name + "/scenes/home.pack", .kind = "SCEN", .hash = {{hash, 2}}}};
    return folder.write(file, test::textOf(test::buildPack(fields)));
  };
  const std::filesystem::path before = worldOf("before.pack", "home", 1);
  const Outcome same = diff({.a = before, .b = worldOf("again.pack", "again", 1)});
  EXPECT_EQ(same.exit_code, kExitOk) << same.out;
  const Outcome other = diff({.a = before, .b = worldOf("home.pack", "home", 3)});
  EXPECT_EQ(other.exit_code, kExitDiffers);
  EXPECT_THAT(other.out, HasSubstr("packs.scenes/home.pack.xxh3_128"));
  EXPECT_THAT(other.out, testing::Not(HasSubstr("mug.pack")));
  EXPECT_THAT(other.out, testing::Not(HasSubstr("sources.")));
}

TEST(DiffVerb, PairsThePacksOfWorldsByTheirPathsBelowTheWorldsFolders) {
  const test::ScratchFolder folder;
  const auto worldOf = [&](const std::string& name, std::uint64_t hash) {
    test::WorldPackFields fields;
    fields.packs = {{.path = name + "/objects/mug.pack", .kind = "OBJS"},
                    {.path = name + "/scenes/home.pack", .kind = "SCEN", .hash = {{hash, 2}}},
                    {.path = "scenes/shared.pack", .kind = "SCEN"}};
    return folder.write(name + ".pack", test::textOf(test::buildPack(fields)));
  };
  const std::filesystem::path home = worldOf("home", 1);
  const Outcome same = diff({.a = home, .b = worldOf("again", 1)});
  EXPECT_EQ(same.exit_code, kExitOk) << same.out;
  EXPECT_THAT(same.out, HasSubstr("\nequal\n"));
  const Outcome other = diff({.a = home, .b = worldOf("other", 3)});
  EXPECT_EQ(other.exit_code, kExitDiffers);
  EXPECT_THAT(other.out, HasSubstr("packs.scenes/home.pack.xxh3_128"));
  EXPECT_THAT(other.out, testing::Not(HasSubstr("mug.pack")));
}

}  // namespace
}  // namespace galactic::pack_tool::diff_test
