// The worked example of docs/packs.md: the numbers printed there are the ones the encoder writes.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "galactic/bake/columns.h"
#include "layout/column_cell.h"
#include "support/build_paths.h"

namespace galactic::bake::packs_example_test {
namespace {

using testing::HasSubstr;

/// Three columns along x: one span, a shelf with two, a bookshelf with three; and a blocked one.
Columns exampleColumns() {
  Columns columns;
  columns.frame.radius = 0.05F;
  columns.frame.spacing = 0.03F;
  columns.frame.heights = {0.0F, 3.0F};
  columns.frame.columns_x = 4;
  columns.frame.columns_z = 1;
  columns.spans = {{0.05F, 2.55F}, {0.05F, 0.65F}, {0.8F, 2.55F},
                   {0.05F, 0.4F},  {0.55F, 0.9F},  {1.05F, 2.55F}};
  columns.first = {0, 1, 3, 6, 6};
  return columns;
}

std::string readDocument() {
  std::ifstream file(test::sourceFolder() / "docs/packs.md");
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

TEST(PacksDocument, ShowsTheCellsThatTheEncoderWrites) {
  const EncodedGrid grid = encodeGrid(exampleColumns());
  const std::string document = readDocument();
  ASSERT_EQ(grid.cells.size(), std::size_t{kCellsPerTile});
  for (std::uint32_t i = 0; i < kCellsPerTile; ++i) {
    EXPECT_THAT(document, HasSubstr(fmt::format("| {} | `{:016x}` |", i, grid.cells[i])));
  }
}

TEST(PacksDocument, ShowsTheQuantumOfItsExample) {
  const EncodedGrid grid = encodeGrid(exampleColumns());
  EXPECT_THAT(readDocument(), HasSubstr(fmt::format("quantum is {:.9g} m", grid.quantum)));
}

TEST(PacksDocument, ShowsTheOverflowOfItsExample) {
  const EncodedGrid grid = encodeGrid(exampleColumns());
  EXPECT_EQ(grid.overflow_codes.size(), 4U);
  const std::string document = readDocument();
  std::string codes;
  for (const std::uint32_t pair : grid.overflow_codes) {
    codes += fmt::format("{}`{:08x}`", codes.empty() ? "" : ", ", pair);
  }
  EXPECT_THAT(document, HasSubstr(fmt::format("`overflow_codes` is {}", codes)));
}

}  // namespace
}  // namespace galactic::bake::packs_example_test
