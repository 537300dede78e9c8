#include "galactic/pack.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <utility>
#include <vector>

#include "galactic/episode_set.h"
#include "galactic/object_set.h"
#include "galactic/robot.h"
#include "galactic/scene.h"
#include "galactic/schema/pack_generated.h"
#include "galactic/world.h"
#include "layout/column_cell.h"
#include "support/packs/pack_parts.h"
#include "support/packs/scene_pack_builder.h"

namespace galactic::test::pack_test {
namespace {

using testing::HasSubstr;

// What points into a pack cannot be made of one that ends with the statement.
template <class T, class Pack>
concept MadeOf = requires(Pack&& pack) {
  T::from(std::forward<Pack>(pack));
};
static_assert(MadeOf<Scene, const PackFile&> && !MadeOf<Scene, PackFile>);
static_assert(MadeOf<Robot, const PackFile&> && !MadeOf<Robot, PackFile>);
static_assert(MadeOf<ObjectSet, const PackFile&> && !MadeOf<ObjectSet, PackFile>);
static_assert(MadeOf<EpisodeSet, const PackFile&> && !MadeOf<EpisodeSet, PackFile>);

/// A file in the test's folder for scratch files, gone at the end.
class PackOnDisk {
 public:
  explicit PackOnDisk(std::span<const std::byte> bytes) {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    path_ = std::filesystem::path(testing::TempDir()) /
            (std::string(test->test_suite_name()) + "." + test->name() + ".pack");
    std::ofstream(path_, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
  }
  ~PackOnDisk() { std::filesystem::remove(path_); }
  PackOnDisk(const PackOnDisk&) = delete;
  PackOnDisk& operator=(const PackOnDisk&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

void expectSmallScene(const PackFile& pack) {
  const Result<Scene> scene = Scene::from(pack);
  ASSERT_TRUE(scene.has_value()) << scene.error().message;
  EXPECT_EQ(scene->name(), "kitchen");
  ASSERT_EQ(scene->grids().size(), 2U);
  EXPECT_EQ(scene->gridIndex(0.5F), 0U);
  EXPECT_EQ(scene->gridIndex(0.75F), 1U);
  EXPECT_EQ(scene->gridIndex(0.7F), std::nullopt);
  const ScenePackFields fields = smallScene();
  for (std::size_t n = 0; n < 2; ++n) {
    const TestGrid& made = fields.grids[n].grid;
    const ColumnGrid& grid = scene->grids()[n];
    EXPECT_EQ(grid.radius(), made.spec.radius);
    EXPECT_EQ(grid.spacing(), made.spec.spacing);
    EXPECT_EQ(grid.heights(), made.spec.heights);
    for (std::uint32_t k = 0; k < grid.columnsZ(); ++k) {
      for (std::uint32_t i = 0; i < grid.columnsX(); ++i) {
        std::vector<Span> spans(grid.spanCount(i, k));
        grid.spans(i, k, spans);
        EXPECT_EQ(spans, made.columns[k * made.spec.columns_x + i]) << i << " " << k;
      }
    }
  }
}

TEST(PackFile, OpensAFileAndAnswersQueriesFromIt) {
  const AlignedBytes bytes = buildPack(smallScene());
  const PackOnDisk file(bytes.bytes());
  for (const Trust trust : {Trust::kVerify, Trust::kTrusted}) {
    Result<PackFile> opened = PackFile::open(file.path(), trust);
    ASSERT_TRUE(opened.has_value()) << opened.error().text();
    EXPECT_EQ(opened->kind(), PackKind::kScene);
    EXPECT_EQ(opened->bytes().size(), bytes.size());
    EXPECT_EQ(opened->where(), file.path().string());
    const PackFile moved = std::move(*opened);
    expectSmallScene(moved);
  }
}

TEST(PackFile, ViewsMemoryWhereverTheTilesBeginInTheirCacheLine) {
  // A longer text shifts the vectors by 32 bytes against the file's cache lines.
  std::array<int, 2> seen{};
  for (std::size_t length = 1; length <= 128; ++length) {
    ScenePackFields fields = smallScene();
    fields.format = std::string(length, 'f');
    const AlignedBytes bytes = buildPack(fields);
    const Result<PackFile> pack = PackFile::view(bytes.bytes(), "memory");
    ASSERT_TRUE(pack.has_value()) << pack.error().text();
    expectSmallScene(*pack);
    const auto* stored = pack->root().asset_as_Scene()->column_grids()->Get(0)->cells()->Data();
    const auto offset =
        static_cast<std::size_t>(reinterpret_cast<const std::byte*>(stored) - pack->bytes().data());
    const std::size_t padding = tilePadding(offset);
    ASSERT_TRUE(padding == 0 || padding == kTilePaddingCells);
    ++seen[padding == 0 ? 0 : 1];
  }
  EXPECT_GT(seen[0], 12);
  EXPECT_GT(seen[1], 12);
}

TEST(PackFile, RefusesMemoryThatIsNotAligned) {
  const AlignedBytes bytes = buildPack(smallScene());
  std::vector<std::byte> shifted(sizeof(std::byte) * 64);
  shifted.insert(shifted.end(), bytes.bytes().begin(), bytes.bytes().end());
  const AlignedBytes copy(shifted);
  EXPECT_TRUE(PackFile::view(copy.bytes().subspan(64), "memory").has_value());
  const Result<PackFile> pack = PackFile::view(copy.bytes().subspan(16), "memory");
  ASSERT_FALSE(pack.has_value());
  EXPECT_EQ(pack.error().code, ErrorCode::kInvalidInput);
  EXPECT_EQ(pack.error().where, "memory");
  EXPECT_THAT(pack.error().message, HasSubstr("not a multiple of 32"));
}

TEST(PackFile, NamesAMissingFile) {
  const Result<PackFile> pack = PackFile::open("/nowhere/kitchen.pack");
  ASSERT_FALSE(pack.has_value());
  EXPECT_EQ(pack.error().code, ErrorCode::kIo);
  EXPECT_EQ(pack.error().where, "/nowhere/kitchen.pack");
}

/// What opening says about a small scene's file after `change`.
template <class Change>
Error errorAfter(Change change, Trust trust = Trust::kVerify) {
  AlignedBytes bytes = buildPack(smallScene());
  PackHeader header;
  std::memcpy(&header, bytes.bytes().data(), sizeof(header));
  change(header);
  std::memcpy(bytes.bytes().data(), &header, sizeof(header));
  const Result<PackFile> pack = PackFile::view(bytes.bytes(), "kitchen.pack", trust);
  return pack ? Error{ErrorCode::kInternal, "", "no error"} : pack.error();
}

TEST(PackFile, RefusesEachWrongFieldOfTheHeaderInBothTrusts) {
  for (const Trust trust : {Trust::kVerify, Trust::kTrusted}) {
    EXPECT_THAT(errorAfter([](PackHeader& h) { h.magic[7] = 'X'; }, trust).message,
                HasSubstr("does not begin with \"GALAPACK\""));
    const Error newer = errorAfter([](PackHeader& h) { h.format_version = 7; }, trust);
    EXPECT_EQ(newer.code, ErrorCode::kUnsupported);
    EXPECT_EQ(newer.message, "has format version 7, this program reads up to 1; update galactic");
    const Error older = errorAfter([](PackHeader& h) { h.format_version = 0; }, trust);
    EXPECT_EQ(older.code, ErrorCode::kUnsupported);
    EXPECT_EQ(older.message, "has format version 0, this program reads 1 to 1; bake it again");
    EXPECT_THAT(errorAfter([](PackHeader& h) { h.kind = static_cast<PackKind>(0x31323334); }, trust)
                    .message,
                HasSubstr("unknown kind 0x31323334"));
    EXPECT_THAT(errorAfter([](PackHeader& h) { ++h.payload_bytes; }, trust).message,
                HasSubstr("it is truncated or has bytes too many"));
    EXPECT_THAT(errorAfter([](PackHeader& h) { h.reserved[31] = std::byte{1}; }, trust).message,
                HasSubstr("reserved header bytes that are not zero"));
  }
}

TEST(PackFile, ComparesThePayloadWithItsHashUnlessItIsTrusted) {
  const auto change = [](PackHeader& h) { h.payload_xxh64 ^= 1; };
  EXPECT_THAT(errorAfter(change).message, HasSubstr("payload hash is"));
  EXPECT_EQ(errorAfter(change, Trust::kTrusted).message, "no error");
}

TEST(PackHeader, FindsEachKindByItsFourCharactersAndNoOther) {
  for (const PackKind kind : {PackKind::kScene, PackKind::kObjects, PackKind::kRobot,
                              PackKind::kEpisodes, PackKind::kWorld}) {
    EXPECT_EQ(packKindOf(packKindName(kind)), kind);
  }
  for (const char* name : {"", "SCE", "SCENE", "scen", "ELSE"}) {
    EXPECT_EQ(packKindOf(name), std::nullopt) << name;
  }
}

TEST(PackFile, RefusesAPayloadThatIsNoFlatBufferOfOurs) {
  for (const Trust trust : {Trust::kVerify, Trust::kTrusted}) {
    for (const std::size_t size : {0U, 1U, 7U, 8U, 100U}) {
      const std::vector<std::byte> payload(size);
      const AlignedBytes bytes = packFile(PackKind::kScene, payload);
      const Result<PackFile> pack = PackFile::view(bytes.bytes(), "zeros.pack", trust);
      ASSERT_FALSE(pack.has_value());
      EXPECT_EQ(pack.error().code, ErrorCode::kInvalidInput);
      EXPECT_THAT(pack.error().message, HasSubstr("does not carry the identifier \"GALP\""));
    }
  }
}

// NOLINTBEGIN(bugprone-use-after-move): what is left then is what it tells of.
TEST(PackFile, HoldsNothingOnceItIsMoved) {
  const AlignedBytes bytes = buildPack(smallScene());
  Result<PackFile> pack = PackFile::view(bytes.bytes(), "home.pack");
  ASSERT_TRUE(pack.has_value());
  PackFile moved = std::move(*pack);
  EXPECT_EQ(moved.where(), "home.pack");
  EXPECT_TRUE(Scene::from(moved).has_value());
  const auto expectEmpty = [](const PackFile& empty) {
    EXPECT_TRUE(empty.bytes().empty());
    EXPECT_THROW(static_cast<void>(empty.root()), ErrorException);
    EXPECT_THROW(static_cast<void>(Scene::from(empty)), ErrorException);
  };
  expectEmpty(*pack);
  *pack = std::move(moved);
  EXPECT_TRUE(Scene::from(*pack).has_value());
  expectEmpty(moved);
  std::vector<PackFile> packs;
  packs.push_back(std::move(moved));
  EXPECT_THROW(static_cast<void>(World::from(std::move(packs))), ErrorException);
}
// NOLINTEND(bugprone-use-after-move)

TEST(Scene, RefusesATrustedPackOfAnotherKind) {
  ScenePackFields fields = smallScene();
  fields.kind = PackKind::kWorld;
  fields.holds_world = true;
  const AlignedBytes bytes = buildPack(fields);
  const Result<PackFile> pack = PackFile::view(bytes.bytes(), "home.pack", Trust::kTrusted);
  ASSERT_TRUE(pack.has_value());
  const Result<Scene> scene = Scene::from(*pack);
  ASSERT_FALSE(scene.has_value());
  EXPECT_EQ(scene.error().code, ErrorCode::kInvalidInput);
  EXPECT_EQ(scene.error().where, "home.pack");
  EXPECT_EQ(scene.error().message,
            "is a pack of kind WRLD, expected a scene (SCEN); give the pack of a scene");
}

}  // namespace
}  // namespace galactic::test::pack_test
