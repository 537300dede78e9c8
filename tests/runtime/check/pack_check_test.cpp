// One wrong value per field of a scene pack whose hash is right: each has its own message.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "galactic/pack.h"
#include "galactic/schema/pack_generated.h"
#include "layout/column_cell.h"
#include "support/packs/scene_pack_builder.h"

namespace galactic::test::pack_check_test {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr double kNanDouble = std::numeric_limits<double>::quiet_NaN();

/// A change of a valid pack and what opening must say then; "; bake the pack again" follows.
struct Offence {
  std::string where;
  std::string message;
  std::function<void(ScenePackFields&)> change;
};

void expectRefused(const Offence& offence) {
  SCOPED_TRACE(offence.where + ": " + offence.message);
  ScenePackFields fields = smallScene();
  offence.change(fields);
  const AlignedBytes bytes = buildPack(fields);
  const Result<PackFile> pack = PackFile::view(bytes.bytes(), "kitchen.pack");
  ASSERT_FALSE(pack.has_value());
  EXPECT_EQ(pack.error().code, ErrorCode::kInvalidInput);
  EXPECT_EQ(pack.error().where, "kitchen.pack: " + offence.where);
  EXPECT_EQ(pack.error().message, offence.message + "; bake the pack again");
}

void expectRefused(const std::vector<Offence>& offences) {
  for (const Offence& offence : offences) expectRefused(offence);
}

TEST(PackCheck, AcceptsTheScenesThatTheOffencesBelowStartFrom) {
  const AlignedBytes bytes = buildPack(smallScene());
  const Result<PackFile> pack = PackFile::view(bytes.bytes(), "kitchen.pack");
  ASSERT_TRUE(pack.has_value()) << pack.error().text();
}

TEST(PackCheck, AcceptsASceneWithoutTheOptionalStatistics) {
  ScenePackFields fields = smallScene();
  for (GridFields& grid : fields.grids) {
    grid.cast_check.reset();
    grid.regions.clear();
  }
  const AlignedBytes bytes = buildPack(fields);
  EXPECT_TRUE(PackFile::view(bytes.bytes(), "kitchen.pack").has_value());
}

TEST(PackCheck, RefusesWrongProvenance) {
  expectRefused({
      {"provenance.tool", "is empty, expected a program's name",
       [](ScenePackFields& f) { f.tool.clear(); }},
      {"provenance.tool_version", "is empty, expected a version",
       [](ScenePackFields& f) { f.tool_version.clear(); }},
      {"provenance.options[0].name", "is empty, expected an option's name",
       [](ScenePackFields& f) { f.option_name.clear(); }},
      {"provenance.sources[0].name", "is empty or an absolute path, expected a relative path",
       [](ScenePackFields& f) { f.source_name.clear(); }},
      {"provenance.sources[0].name", "is empty or an absolute path, expected a relative path",
       [](ScenePackFields& f) { f.source_name = "/home/me/kitchen.glb"; }},
      {"provenance.sources[0].hash", "is missing, expected the file's hash",
       [](ScenePackFields& f) { f.source_has_hash = false; }},
  });
}

TEST(PackCheck, RefusesWrongValuesOfTheScene) {
  expectRefused({
      {"scene.name", "is empty, expected the scene's name",
       [](ScenePackFields& f) { f.name.clear(); }},
      {"scene.bounds", "reach farther than 800 m or are not finite, expected coordinates",
       [](ScenePackFields& f) { f.bounds_min.y = kNan; }},
      {"scene.bounds", "reach farther than 800 m or are not finite, expected coordinates",
       [](ScenePackFields& f) { f.bounds_max.x = kInfinity; }},
      {"scene.bounds", "have a minimum (6, 0, 0) above the maximum (5, 8, 3)",
       [](ScenePackFields& f) { f.bounds_min.x = 6; }},
      {"scene.import_statistics.format", "is empty, expected a format's name",
       [](ScenePackFields& f) { f.format.clear(); }},
      {"scene.import_statistics.triangles_read",
       "is 9, expected at least the 3 degenerate and 7 duplicate triangles dropped",
       [](ScenePackFields& f) { f.triangles_read = 9; }},
      {"scene.import_statistics.triangles", "is 91, expected the 90 that remain of those read",
       [](ScenePackFields& f) { f.triangles = 91; }},
      {"scene.column_grids", "has 0 grids, expected 1 to 8",
       [](ScenePackFields& f) { f.grids.clear(); }},
      {"scene.column_grids", "has 9 grids, expected 1 to 8",
       [](ScenePackFields& f) { f.grids.resize(9, f.grids[0]); }},
      {"scene.column_grids[1].radius", "is 0.5 m after 0.5 m, expected ascending radii",
       [](ScenePackFields& f) { f.grids[1].grid.spec.radius = 0.5F; }},
  });
}

/// An offence of the second grid, the tall one.
Offence inTallGrid(const std::string& field, const std::string& message,
                   std::function<void(GridFields&)> change) {
  return {"scene.column_grids[1]." + field, message,
          [change = std::move(change)](ScenePackFields& f) { change(f.grids[1]); }};
}

/// An offence of the first grid.
Offence inGrid(const std::string& field, const std::string& message,
               std::function<void(GridFields&)> change) {
  return {"scene.column_grids[0]." + field, message,
          [change = std::move(change)](ScenePackFields& f) { change(f.grids[0]); }};
}

TEST(PackCheck, RefusesWrongLengthsOfAGrid) {
  const auto spec = [](auto member, auto value) {
    return [=](GridFields& g) { g.grid.spec.*member = value; };
  };
  expectRefused({
      inGrid("radius", "is 0 m, expected a number above 0", spec(&GridSpec::radius, 0.0F)),
      inGrid("radius", "is nan m, expected a number above 0", spec(&GridSpec::radius, kNan)),
      inGrid("radius", "is 0.49 m, expected at least half the spacing of 1 m",
             spec(&GridSpec::radius, 0.49F)),
      inGrid("spacing", "is 0 m, expected a length of at least 1e-05 m",
             spec(&GridSpec::spacing, 0.0F)),
      inGrid("spacing", "is -1 m, expected a length of at least 1e-05 m",
             spec(&GridSpec::spacing, -1.0F)),
      inGrid("spacing", "is inf m, expected a length of at least 1e-05 m",
             spec(&GridSpec::spacing, kInfinity)),
      inGrid("spacing", "is 1e-40 m, expected a length of at least 1e-05 m",
             spec(&GridSpec::spacing, 1e-40F)),
      inGrid("spacing", "is 9e-06 m, expected a length of at least 1e-05 m",
             spec(&GridSpec::spacing, 9e-6F)),
      inGrid("quantum", "is 0 m, expected a number above 0", spec(&GridSpec::quantum, 0.0F)),
      inGrid("quantum", "is nan m, expected a number above 0", spec(&GridSpec::quantum, kNan)),
      inGrid("min_x", "is nan m, expected up to 1000 m", spec(&GridSpec::min_x, kNan)),
      inGrid("min_z", "is -inf m, expected up to 1000 m", spec(&GridSpec::min_z, -kInfinity)),
      inGrid("heights", "are nan to 8 m, expected ascending heights of up to 1000 m",
             spec(&GridSpec::heights, Span{kNan, 8})),
      inGrid("heights", "are 0 to inf m, expected ascending heights of up to 1000 m",
             spec(&GridSpec::heights, Span{0, kInfinity})),
      inGrid("heights", "are 9 to 8 m, expected ascending heights of up to 1000 m",
             spec(&GridSpec::heights, Span{9, 8})),
      inGrid("heights", "are missing, expected the grid's range of heights",
             [](GridFields& g) { g.has_heights = false; }),
  });
}

TEST(PackCheck, RefusesWrongSizesOfAGrid) {
  const auto spec = [](auto member, auto value) {
    return [=](GridFields& g) { g.grid.spec.*member = value; };
  };
  expectRefused({
      inGrid("columns_x", "is 0, expected 1 to 134217728", spec(&GridSpec::columns_x, 0U)),
      inGrid("columns_x", "is 4294967295, expected 1 to 134217728",
             spec(&GridSpec::columns_x, 0xffffffffU)),
      inGrid("columns_z", "is 0, expected 1 to 134217728", spec(&GridSpec::columns_z, 0U)),
      inGrid("columns_z", "is 4294967295, expected 1 to 134217728",
             spec(&GridSpec::columns_z, 0xffffffffU)),
      inGrid("columns_x", "times columns_z needs 268435456 cells, expected up to 134217728",
             [](GridFields& g) {
               g.grid.spec.columns_x = 1U << 14U;
               g.grid.spec.columns_z = 1U << 14U;
             }),
      inGrid("columns_x", "and columns_z are 5 and 3, expected an end within 1000 m",
             [](GridFields& g) { g.grid.spec.min_x = 999.9F; }),
      inGrid("min_x", "is 1e+20 m, expected up to 1000 m", spec(&GridSpec::min_x, 1e20F)),
      inGrid("cells", "has 36 elements, expected 52 for 9 x 3 columns",
             spec(&GridSpec::columns_x, 9U)),
      inGrid("cells", "has 37 elements, expected 36 for 5 x 3 columns",
             [](GridFields& g) { g.extra_cells = 1; }),
      inGrid("tile_base", "has 3 elements, expected none or 4, one per tile",
             [](GridFields& g) { g.grid.tile_base.assign(3, 0); }),
      inGrid("coverage", "is 2, expected a value up to 1", [](GridFields& g) { g.coverage = 2; }),
  });
}

TEST(PackCheck, RefusesWrongStatistics) {
  const auto cast = [](auto member, auto value) {
    return [=](GridFields& g) { (*g.cast_check).*member = value; };
  };
  const std::string check = "statistics.cast_check.";
  const std::string length = " m, expected a finite length of 0 or more";
  expectRefused({
      inGrid("statistics.spans", "is 12, expected the 11 spans that the cells hold",
             [](GridFields& g) { ++g.spans; }),
      inGrid("statistics.max_spans_per_column", "is 3, expected the 4 that the cells hold",
             [](GridFields& g) { --g.max_spans_per_column; }),
      inGrid("statistics.regions[1].region", "is 3, expected a value up to 2",
             [](GridFields& g) { g.regions[1].region = 3; }),
      inGrid("statistics.regions[2].volume", "is nan m3, expected a finite volume of 0 or more",
             [](GridFields& g) { g.regions[2].volume = kNanDouble; }),
      inGrid("statistics.regions[0].volume", "is -1 m3, expected a finite volume of 0 or more",
             [](GridFields& g) { g.regions[0].volume = -1; }),
      inGrid(check + "columns_differing", "is 9, expected at most the 8 columns replayed",
             cast(&CastCheckFields::columns_differing, 9U)),
      inGrid(check + "compared", "is nan" + length, cast(&CastCheckFields::compared, kNanDouble)),
      inGrid(check + "method", "is -1" + length, cast(&CastCheckFields::method, -1.0)),
      inGrid(check + "ties", "is nan" + length, cast(&CastCheckFields::ties, kNanDouble)),
      inGrid(check + "errors", "is nan" + length, cast(&CastCheckFields::errors, kNanDouble)),
  });
}

/// Where element `cell` of a grid's tiles stands in the stored vector: after the padding,
/// which depends on the pack's size.
std::string cellField(std::size_t cell, flatbuffers::uoffset_t grid = 0) {
  const AlignedBytes bytes = buildPack(smallScene());
  const Result<PackFile> pack = PackFile::view(bytes.bytes(), "kitchen.pack");
  const auto* stored = pack->root().asset_as_Scene()->column_grids()->Get(grid)->cells();
  const auto offset = reinterpret_cast<const std::byte*>(stored->Data()) - pack->bytes().data();
  return "cells[" + std::to_string(cell + tilePadding(static_cast<std::size_t>(offset))) + "]";
}

/// An offence of one cell of the first grid. Cell 0 has one span (4096 to 8192), cell 1 two, cell 2
/// none, cells 6 and 19 are the overflow cells, cell 9 lies beyond the last column.
Offence inCell(std::size_t cell, std::uint64_t value, const std::string& message) {
  return inGrid(cellField(cell), message, [=](GridFields& g) { g.grid.cells[cell] = value; });
}

std::uint64_t cellOf(std::uint64_t first, std::uint64_t second = kEmptySpanCode) {
  return first | (second << 32U);
}

TEST(PackCheck, RefusesWrongCells) {
  const std::string none = ", expected ascending codes or (65535, 0) for none";
  const std::string top = ", expected at most 32769, the top of the grid";
  expectRefused({
      inCell(0, cellOf(spanCode(5, 4)), "has a first span of codes 5 to 4" + none),
      inCell(0, cellOf(spanCode(0xffff, 1)), "has a first span of codes 65535 to 1" + none),
      inCell(0, cellOf(spanCode(1, 32770)), "has a first span up to code 32770" + top),
      inCell(0, cellOf(spanCode(1, 0xffff)), "has a first span up to code 65535" + top),
      inCell(0, cellOf(spanCode(1, 2), spanCode(4, 3)), "has a second span of codes 4 to 3" + none),
      inCell(0, cellOf(spanCode(1, 2), spanCode(4, 0xffff)),
             "has a second span up to code 65535" + top),
      inCell(0, cellOf(spanCode(1, 2), 0xffffffff), "has a second span up to code 65535" + top),
      inCell(0, cellOf(spanCode(1, 2), 0),
             "has a second span from code 0 and a first one to code 2, expected ascending disjoint "
             "spans"),
      inCell(0, cellOf(spanCode(1, 2), spanCode(2, 3)),
             "has a second span from code 2 and a first one to code 2, expected ascending disjoint "
             "spans"),
      inCell(0, cellOf(kEmptySpanCode, spanCode(1, 2)), "has a second span but no first one"),
      inCell(9, cellOf(spanCode(1, 2)),
             "lies beyond the last column and is 0xffff00020001, expected blocked 0xffff0000ffff"),
      inCell(6, overflowCell(1), "is an overflow cell whose spans begin at element 1, expected 0"),
      inCell(19, overflowCell(0), "is an overflow cell whose spans begin at element 0, expected 4"),
      inCell(19, overflowCell(0xffffffff),
             "is an overflow cell whose spans begin at element 4294967295, expected 4"),
      inGrid(cellField(6), "is an overflow cell whose spans begin at element 0, expected 4",
             [](GridFields& g) { g.grid.cells[2] = overflowCell(0); }),
  });
}

TEST(PackCheck, RefusesUnusedElementsThatAreNotZero) {
  const AlignedBytes valid = buildPack(smallScene());
  ScenePackFields fields = smallScene();
  fields.grids[0].padding_value = 7;
  const AlignedBytes bytes = buildPack(fields);
  const Result<PackFile> pack = PackFile::view(bytes.bytes(), "kitchen.pack");
  ASSERT_FALSE(pack.has_value());
  const bool before = cellField(0) == "cells[4]";
  EXPECT_EQ(pack.error().where,
            std::string("kitchen.pack: scene.column_grids[0].cells[") + (before ? "0]" : "32]"));
  EXPECT_EQ(pack.error().message,
            "is an unused element of value 0x7, expected 0; bake the pack again");
}

TEST(PackCheck, RefusesVectorsThatAreNotAligned) {
  // How far off they are depends on what stands around: try until they are off by 8 bytes or more.
  int refused = 0;
  for (std::size_t length = 1; length <= 32; ++length) {
    ScenePackFields fields = smallScene();
    fields.grids[1].cells_alignment = 8;
    fields.warning = std::string(length, 'w');
    const AlignedBytes bytes = buildPack(fields);
    const Result<PackFile> pack = PackFile::view(bytes.bytes(), "kitchen.pack");
    if (pack) continue;
    ++refused;
    EXPECT_EQ(pack.error().where, "kitchen.pack: scene.column_grids[1].cells");
    EXPECT_NE(pack.error().message.find("expected a multiple of 32"), std::string::npos);
  }
  EXPECT_GT(refused, 0);
}

TEST(PackCheck, RefusesWrongTileBases) {
  expectRefused(
      inTallGrid(cellField(0, 1),
                 "has a first span up to code 20480, expected at most -1, the top of the grid",
                 [](GridFields& g) { g.grid.tile_base[0] = 0xffff; }));
}

TEST(PackCheck, RefusesOverflowListsThatDoNotEndWhereTheyShould) {
  const std::string no_end =
      "begins the spans of an overflow cell, expected an end mark behind them";
  const std::string empty = "is an end mark, expected the first span of an overflow cell";
  expectRefused({
      inGrid("overflow_codes[4]", no_end, [](GridFields& g) { g.grid.overflow_codes.pop_back(); }),
      inGrid("overflow_codes[4]", no_end, [](GridFields& g) { g.grid.overflow_codes.resize(4); }),
      inGrid("overflow_codes[0]", empty,
             [](GridFields& g) { g.grid.overflow_codes[0] = kEndOfCodes; }),
      inGrid(cellField(19), "is an overflow cell whose spans begin at element 4, expected 3",
             [](GridFields& g) { g.grid.overflow_codes[2] = kEndOfCodes; }),
      inGrid("overflow_codes[9]",
             "belongs to no overflow cell, expected 9 elements as the cells name "
             "them",
             [](GridFields& g) { g.grid.overflow_codes.push_back(kEndOfCodes); }),
      inTallGrid("overflow_spans[4]", no_end,
                 [](GridFields& g) { g.grid.overflow_spans.pop_back(); }),
      inTallGrid("overflow_spans[4]", empty,
                 [](GridFields& g) { g.grid.overflow_spans[4] = kEndOfSpans; }),
      inTallGrid("overflow_spans[6]",
                 "belongs to no overflow cell, expected 6 elements as the cells name them",
                 [](GridFields& g) {
                   g.grid.overflow_spans.push_back({1, 2});
                 }),
  });
}

TEST(PackCheck, RefusesWrongOverflowCodes) {
  // Heights of codes: multiples of 1/4096 m.
  const auto codes = [](std::size_t n, std::uint32_t lo, std::uint32_t hi) {
    return [=](GridFields& g) {
      g.grid.overflow_codes[n] = static_cast<std::uint32_t>(spanCode(lo, hi));
    };
  };
  const std::string inside = ", expected ascending finite heights inside the grid's 0 to 8 m";
  const std::string above = ", expected above the end of the span before it in its column";
  expectRefused({
      inGrid("overflow_codes[0]", "is 2 to 1 m" + inside, codes(0, 8192, 4096)),
      inGrid("overflow_codes[2]", "is 5 to 15 m" + inside, codes(2, 20480, 61440)),
      inGrid("overflow_codes[1]", "begins at 2 m" + above, codes(1, 8192, 16384)),
      inGrid("overflow_codes[7]", "begins at 1 m" + above, codes(7, 4096, 16384)),
      inTallGrid("overflow_codes",
                 "has 1 elements in a grid with tile bases, expected none: overflow_spans has its "
                 "spans",
                 [](GridFields& g) { g.grid.overflow_codes.assign(1, 0); }),
  });
}

TEST(PackCheck, RefusesWrongOverflowSpans) {
  const auto span = [](std::size_t n, Span value) {
    return [=](GridFields& g) { g.grid.overflow_spans[n] = value; };
  };
  const std::string inside = ", expected ascending finite heights inside the grid's -4 to 36 m";
  const std::string above = ", expected above the end of the span before it in its column";
  expectRefused({
      inTallGrid("overflow_spans[0]", "is nan to 1 m" + inside, span(0, {kNan, 1})),
      inTallGrid("overflow_spans[0]", "is 0 to nan m" + inside, span(0, {0, kNan})),
      inTallGrid("overflow_spans[4]", "is 1 to inf m" + inside, span(4, {1, kInfinity})),
      inTallGrid("overflow_spans[2]", "is 5 to 4 m" + inside, span(2, {5, 4})),
      inTallGrid("overflow_spans[4]", "is 1 to 36.5 m" + inside, span(4, {1, 36.5F})),
      inTallGrid("overflow_spans[0]", "is -4.5 to 1 m" + inside, span(0, {-4.5F, 1})),
      inTallGrid("overflow_spans[1]", "begins at 1 m" + above, span(1, {1, 3})),
      inGrid("overflow_spans",
             "has 1 elements in a grid without tile bases, expected none: overflow_codes has its "
             "spans",
             [](GridFields& g) {
               g.grid.overflow_spans.assign(1, Span{1, 2});
             }),
  });
}

/// What schema/column_grid.fbs allows for a cell that is no overflow cell.
bool isWellFormed(std::uint64_t cell, std::uint32_t highest) {
  const auto code = [cell](unsigned n) {
    return static_cast<std::uint32_t>((cell >> (16U * n)) & 0xffffU);
  };
  const auto empty = [&](unsigned n) { return code(n) == 0xffff && code(n + 1) == 0; };
  const auto span = [&](unsigned n) { return code(n) <= code(n + 1) && code(n + 1) <= highest; };
  if (empty(0)) return empty(2);
  return span(0) && (empty(2) || (span(2) && code(1) < code(2)));
}

TEST(PackCheck, JudgesAnyCellAsTheSchemaDoes) {
  constexpr std::uint32_t kSeed = 301;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  std::mt19937_64 random(kSeed);
  // Codes that matter, so that all cases come up.
  const std::uint64_t codes[] = {0, 1, 2, 3, 32768, 32769, 32770, 65534, 65535};
  const auto code = [&] { return codes[random() % std::size(codes)]; };
  constexpr int kCells = 6000;
  int good = 0;
  for (int n = 0; n < kCells; ++n) {
    const bool plausible = n % 2 == 0;
    const std::uint64_t low =
        plausible ? (random() % 4) | ((3 + random() % 4) << 16U) : code() | (code() << 16U);
    const std::uint64_t high =
        plausible && random() % 2 == 0 ? kEmptySpanCode : code() | (code() << 16U);
    const std::uint64_t cell = low | (high << 32U);
    if (isOverflow(cell)) continue;
    ScenePackFields fields = smallScene();
    fields.grids.pop_back();
    GridFields& grid = fields.grids[0];
    // The statistics follow the cell, so that the cell alone decides.
    grid.grid.cells[0] = cell;
    const bool expected = isWellFormed(cell, 32769);
    if (expected) {
      const std::uint64_t spans =
          (low == kEmptySpanCode ? 0 : 1) + (high == kEmptySpanCode ? 0 : 1);
      grid.spans = grid.spans - 1 + spans;
    }
    const AlignedBytes bytes = buildPack(fields);
    const Result<PackFile> pack = PackFile::view(bytes.bytes(), "kitchen.pack");
    ASSERT_EQ(pack.has_value(), expected)
        << std::hex << cell << " " << (pack ? "" : pack.error().message);
    good += expected ? 1 : 0;
  }
  EXPECT_GT(good, kCells / 10);
  EXPECT_LT(good, kCells * 9 / 10);
}

}  // namespace
}  // namespace galactic::test::pack_check_test
