// From a baked scene to a pack and back through the runtime.
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "galactic/bake/packs.h"
#include "galactic/pack.h"
#include "galactic/scene.h"
#include "galactic/schema/pack_generated.h"
#include "layout/column_cell.h"
#include "support/file_content.h"
#include "support/oracles/encoded_grid_view.h"
#include "support/scene_meshes.h"
#include "support/scratch_folder.h"
#include "support/source_asset.h"

namespace galactic::bake::scene_pack_test {
namespace {

constexpr std::uint32_t kSeed = 20250313;

/// A room and, where `height` is more, a balcony far above it.
TriangleMesh roomWithBalcony(float height) {
  test::MeshBuilder builder;
  builder.box({0, -0.1F, 0}, {2, 0, 1.5F}).box({0.4F, 0.7F, 0.4F}, {1, 0.73F, 1});
  for (int board = 0; board < 4; ++board) {
    const float y = 0.2F + 0.3F * static_cast<float>(board);
    builder.box({1.5F, y, 0.2F}, {1.9F, y + 0.02F, 1});
  }
  builder.box({0, height, 0}, {2, height + 0.1F, 1.5F});
  return builder.build();
}

BakedScene bake(const TriangleMesh& mesh, const SceneBakeOptions& options = {},
                unsigned threads = 1) {
  StageTimes times;
  auto scene = bakeScene(
      test::sourceAssetOf(mesh), options, times, [](auto, auto) {}, threads);
  EXPECT_TRUE(scene) << scene.error().message;
  return std::move(*scene);
}

Provenance provenance() {
  return {.tool_version = "1.2.3",
          .options = {{"radii", "0.015,0.05,0.12"}, {"spacing", "0.03"}},
          .sources = test::sourceAssetOf(roomWithBalcony(2)).read.files,
          .warnings = {"the texture is missing"}};
}

/// The answers of two grids at random places in and around them, bit for bit.
void expectSameAnswers(const ColumnGrid& found, const ColumnGrid& expected) {
  ASSERT_EQ(found.columnsX(), expected.columnsX());
  ASSERT_EQ(found.columnsZ(), expected.columnsZ());
  std::mt19937 random(kSeed);
  const auto number = [&](float lo, float hi) {
    return std::uniform_real_distribution<float>(lo, hi)(random);
  };
  const ColumnGridLayout& layout = expected.layout();
  const float width = layout.spacing * static_cast<float>(layout.columns_x);
  const float depth = layout.spacing * static_cast<float>(layout.columns_z);
  int free = 0;
  constexpr int kQueries = 20000;
  for (int n = 0; n < kQueries; ++n) {
    const Vec3 center{layout.min_x + number(-0.1F, width + 0.1F),
                      number(layout.heights.lo - 0.1F, layout.heights.hi + 0.1F),
                      layout.min_z + number(-0.1F, depth + 0.1F)};
    const Contact a = found.contact(center);
    const Contact b = expected.contact(center);
    ASSERT_EQ(a.clearance, b.clearance);
    ASSERT_EQ(a.down, b.down);
    ASSERT_EQ(a.up, b.up);
    free += a.clearance == Clearance::kFree ? 1 : 0;
  }
  EXPECT_GT(free, kQueries / 10);
  EXPECT_LT(free, kQueries * 95 / 100);
}

/// Writes, opens with every check on, and compares the answers of all grids.
void expectRoundTrip(const BakedScene& scene) {
  const test::ScratchFolder folder;
  const std::filesystem::path path = folder.path() / "room.pack";
  const auto bytes = writeScenePack(path, scene, provenance());
  ASSERT_TRUE(bytes) << bytes.error().message;
  EXPECT_EQ(*bytes, std::filesystem::file_size(path));
  const auto pack = PackFile::open(path);
  ASSERT_TRUE(pack) << pack.error().text();
  EXPECT_EQ(pack->kind(), PackKind::kScene);
  const auto opened = Scene::from(*pack);
  ASSERT_TRUE(opened) << opened.error().message;
  EXPECT_EQ(opened->name(), "room");
  ASSERT_EQ(opened->grids().size(), scene.grids.size());
  for (std::size_t n = 0; n < scene.grids.size(); ++n) {
    SCOPED_TRACE(testing::Message() << "grid " << n);
    expectSameAnswers(opened->grids()[n], test::viewOf(scene.grids[n].grid));
    const auto* tiles = reinterpret_cast<const std::byte*>(opened->grids()[n].layout().cells);
    EXPECT_EQ((tiles - pack->bytes().data()) % static_cast<std::ptrdiff_t>(kTileBytes), 0);
  }
}

TEST(ScenePack, AnswersAsTheGridsDidBeforeTheyWereWritten) {
  expectRoundTrip(bake(test::furnishedRoom(kSeed), {.check_columns = 16}));
}

TEST(ScenePack, KeepsTileBasesAndTallColumns) {
  const BakedScene scene = bake(roomWithBalcony(30), {.check_columns = 4});
  EXPECT_FALSE(scene.grids[0].grid.tile_base.empty());
  EXPECT_FALSE(scene.grids[0].grid.overflow_spans.empty());
  expectRoundTrip(scene);
}

TEST(ScenePack, KeepsCodesOfColumnsWithManySpans) {
  const BakedScene scene = bake(roomWithBalcony(2), {.check_columns = 4});
  EXPECT_TRUE(scene.grids[0].grid.tile_base.empty());
  EXPECT_FALSE(scene.grids[0].grid.overflow_codes.empty());
  expectRoundTrip(scene);
}

/// Every padding in front of the tiles occurs, as names of different lengths move them.
TEST(ScenePack, BeginsTilesAtACacheLineWhateverComesBeforeThem) {
  BakedScene scene = bake(roomWithBalcony(2), {.radii = {0.05F, 0.12F}, .check_columns = 0});
  std::array<int, kTilePaddingCells + 1> paddings{};
  for (std::size_t length = 1; length < 80; ++length) {
    scene.name = std::string(length, 'n');
    const auto payload = encodeScenePack(scene, provenance());
    ASSERT_TRUE(payload);
    const schema::Scene* stored = schema::GetPack(payload->data())->asset_as_Scene();
    for (const schema::ColumnGrid* grid : *stored->column_grids()) {
      const auto at = static_cast<std::size_t>(
          reinterpret_cast<const std::byte*>(grid->cells()->Data()) - payload->data());
      const std::size_t padding = tilePadding(sizeof(PackHeader) + at);
      ASSERT_LE(padding, kTilePaddingCells);
      ++paddings[padding];
      const std::size_t tiles = grid->cells()->size() - kTilePaddingCells;
      const std::vector<std::uint64_t>& cells =
          scene.grids[grid->radius() < 0.1F ? 0 : 1].grid.cells;
      ASSERT_EQ(tiles, cells.size());
      for (std::size_t n = 0; n < grid->cells()->size(); ++n) {
        const bool is_padding = n < padding || n >= padding + tiles;
        const std::uint64_t expected = is_padding ? 0 : cells[n - padding];
        ASSERT_EQ(grid->cells()->Get(static_cast<flatbuffers::uoffset_t>(n)), expected);
      }
    }
  }
  EXPECT_GT(paddings[0], 0);
  EXPECT_GT(paddings[4], 0);
}

TEST(ScenePack, HasTheSameBytesForAnyNumberOfJobsAndOnEveryRun) {
  const test::ScratchFolder folder;
  const TriangleMesh mesh = test::furnishedRoom(kSeed + 1);
  std::string first;
  for (const unsigned threads : {1U, 2U, 5U, 1U}) {
    const std::filesystem::path path = folder.path() / "room.pack";
    ASSERT_TRUE(writeScenePack(path, bake(mesh, {.check_columns = 16}, threads), provenance()));
    const std::string bytes = test::fileContent(path);
    if (first.empty()) first = bytes;
    EXPECT_TRUE(bytes == first) << threads << " threads";
  }
  EXPECT_GT(first.size(), 1000U);
}

TEST(ScenePack, StoresWhereItComesFromAndWhatWasCounted) {
  const BakedScene scene = bake(test::furnishedRoom(kSeed), {.check_columns = 16});
  const auto payload = encodeScenePack(scene, provenance());
  ASSERT_TRUE(payload);
  const schema::Pack* pack = schema::GetPack(payload->data());
  EXPECT_EQ(pack->provenance()->tool()->str(), "galactic-bake");
  EXPECT_EQ(pack->provenance()->tool_version()->str(), "1.2.3");
  EXPECT_EQ(pack->provenance()->options()->Get(1)->value()->str(), "0.03");
  EXPECT_EQ(pack->provenance()->sources()->Get(0)->name()->str(), "room.glb");
  EXPECT_EQ(pack->provenance()->sources()->Get(0)->hash()->high(), 0xfedcba9876543210U);
  EXPECT_EQ(pack->provenance()->warnings()->Get(0)->str(), "the texture is missing");
  const schema::Scene* stored = pack->asset_as_Scene();
  EXPECT_EQ(stored->import_statistics()->triangles(), scene.imported.triangles);
  EXPECT_EQ(stored->import_statistics()->triangles_read(), scene.imported.counts.read);
  EXPECT_EQ(stored->bounds()->min().x(), scene.bounds.min.x);
  EXPECT_EQ(stored->bounds()->max().z(), scene.bounds.max.z);
  const BakedGrid& baked = scene.grids[1];
  const schema::ColumnGrid* grid = stored->column_grids()->Get(1);
  EXPECT_EQ(grid->radius(), 0.05F);
  EXPECT_EQ(grid->coverage(), schema::Coverage::Column);
  EXPECT_EQ(grid->statistics()->spans(), baked.grid.spans);
  EXPECT_EQ(grid->statistics()->raw_spans(), baked.raw_spans);
  EXPECT_EQ(grid->statistics()->slivers(), baked.grid.slivers);
  ASSERT_EQ(grid->statistics()->regions()->size(), kRegionCount);
  for (std::size_t n = 0; n < kRegionCount; ++n) {
    const auto* region = grid->statistics()->regions()->Get(static_cast<flatbuffers::uoffset_t>(n));
    EXPECT_EQ(static_cast<std::size_t>(region->region()), n);
    EXPECT_EQ(region->volume(), baked.totals[n].volume);
  }
  ASSERT_TRUE(baked.cast_check);
  ASSERT_NE(grid->statistics()->cast_check(), nullptr);
  EXPECT_EQ(grid->statistics()->cast_check()->columns(), 16U);
  EXPECT_EQ(grid->statistics()->cast_check()->compared(), baked.cast_check->compared);
}

TEST(ScenePack, SaysWhatAFreeSpanPromises) {
  const BakedScene scene =
      bake(roomWithBalcony(2), {.coverage = Coverage::kCell, .check_columns = 0});
  const auto payload = encodeScenePack(scene, provenance());
  ASSERT_TRUE(payload);
  const schema::ColumnGrid* grid =
      schema::GetPack(payload->data())->asset_as_Scene()->column_grids()->Get(0);
  EXPECT_EQ(grid->coverage(), schema::Coverage::Cell);
  EXPECT_EQ(grid->statistics()->cast_check(), nullptr);
  expectRoundTrip(scene);
}

TEST(ScenePack, ThatCannotBeWrittenIsAnError) {
  const test::ScratchFolder folder;
  const std::filesystem::path path = folder.path() / "missing" / "room.pack";
  const auto written =
      writeScenePack(path, bake(roomWithBalcony(2), {.check_columns = 0}), provenance());
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, ErrorCode::kIo);
  EXPECT_EQ(written.error().where, path.string());
}

}  // namespace
}  // namespace galactic::bake::scene_pack_test
