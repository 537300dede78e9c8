#include "galactic/bake/world_pack.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "galactic/pack_reference.h"
#include "galactic/schema/pack_generated.h"
#include "galactic/world.h"
#include "galactic/world_models.h"
#include "support/homes/small_home_models.h"
#include "support/packs/texture_pack_builder.h"
#include "support/packs/world_pack_builder.h"

namespace galactic::test::world_pack_test {
namespace {

namespace fs = std::filesystem;
using bake::encodeWorldPack;
using bake::LinkedPack;
using bake::linkPacks;
using testing::HasSubstr;

bake::Provenance provenance() {
  bake::Provenance made;
  made.tool_version = "0.1.0";
  return made;
}

/// The packs of a small world in a folder of their own.
class WorldPack : public testing::Test {
 protected:
  void SetUp() override {
    list_ = writePacks(folder_, WorldFields{});
    for (const ReferenceFields& one : list_.packs) paths_.push_back(folder_.path() / one.path);
  }
  [[nodiscard]] fs::path at(const char* name) const { return folder_.path() / name; }

  ScratchFolder folder_;
  WorldPackFields list_;
  std::vector<fs::path> paths_;
};

void expectRefused(const Result<std::vector<LinkedPack>>& linked, const std::string& part) {
  ASSERT_FALSE(linked.has_value());
  EXPECT_EQ(linked.error().code, ErrorCode::kInvalidInput);
  EXPECT_THAT(linked.error().text(), HasSubstr(part));
}

TEST_F(WorldPack, IsOpenedAsAWorldWhateverTheOrderOfItsPacks) {
  std::vector<std::byte> first;
  std::sort(paths_.begin(), paths_.end());
  do {
    const auto linked = linkPacks(paths_, folder_.path());
    ASSERT_TRUE(linked.has_value()) << linked.error().text();
    const auto payload = encodeWorldPack(*linked, provenance());
    ASSERT_TRUE(payload.has_value());
    if (first.empty()) first = *payload;
    EXPECT_TRUE(*payload == first);
  } while (std::next_permutation(paths_.begin(), paths_.end()));
  const auto linked = linkPacks(paths_, folder_.path());
  const auto bytes = writeWorldPack(at("world.pack"), *linked, provenance());
  ASSERT_TRUE(bytes.has_value()) << bytes.error().message;
  EXPECT_EQ(*bytes, fs::file_size(at("world.pack")));
  const auto world = World::open(std::vector{at("world.pack")});
  ASSERT_TRUE(world.has_value()) << world.error().text();
  EXPECT_EQ(world->scenes().size(), 1U);
  EXPECT_EQ(world->robot().name(), "helper");
}

TEST_F(WorldPack, HoldsTheTask) {
  const auto linked = linkPacks(paths_, folder_.path());
  ASSERT_TRUE(linked.has_value());
  const std::vector<OptionText> task{{"task", "pick", true}, {"episode-steps", "300"}};
  ASSERT_TRUE(writeWorldPack(at("world.pack"), *linked, provenance(), task).has_value());
  const auto world = World::open(std::vector{at("world.pack")});
  ASSERT_TRUE(world.has_value()) << world.error().text();
  EXPECT_EQ(world->taskOptions(), task);
  // Without one the pack is what it was before there were tasks: the field is not there.
  const auto without = encodeWorldPack(*linked, provenance(), {});
  ASSERT_TRUE(without.has_value());
  const auto* pack = schema::GetPack(without->data());
  EXPECT_EQ(pack->asset_as_World()->task(), nullptr);
}

TEST_F(WorldPack, ListsPathKindSizeAndHash) {
  const auto linked = linkPacks(paths_, folder_.path());
  ASSERT_TRUE(linked.has_value());
  ASSERT_EQ(linked->size(), list_.packs.size());
  for (std::size_t n = 0; n < linked->size(); ++n) {
    const ReferenceFields& wanted = list_.packs[n];
    EXPECT_EQ((*linked)[n].path, wanted.path);
    EXPECT_EQ(packKindName((*linked)[n].kind), wanted.kind);
    EXPECT_EQ((*linked)[n].bytes, wanted.bytes);
    EXPECT_EQ((*linked)[n].hash_low, wanted.hash->first);
    EXPECT_EQ((*linked)[n].hash_high, wanted.hash->second);
  }
}

TEST_F(WorldPack, FindsPathsThatTakeDetours) {
  paths_[0] = folder_.path() / "robots" / ".." / "." / "episodes.pack";
  const auto linked = linkPacks(paths_, folder_.path() / "robots" / "..");
  ASSERT_TRUE(linked.has_value()) << linked.error().message;
  EXPECT_EQ((*linked)[0].path, "episodes.pack");
  // A link to the folder is the folder.
  fs::create_directory_symlink(folder_.path(), at("again"));
  for (fs::path& path : paths_) {
    path = at("again") / fs::path(path).lexically_relative(folder_.path()).lexically_normal();
  }
  const auto through_link = linkPacks(paths_, at("again"));
  ASSERT_TRUE(through_link.has_value()) << through_link.error().message;
  EXPECT_EQ(*through_link, *linked);
}

TEST_F(WorldPack, RefusesPacksOutsideItsFolder) {
  expectRefused(linkPacks(paths_, at("scenes")), "put the world pack above all its packs");
}

TEST_F(WorldPack, RefusesPacksThatMakeNoWorld) {
  auto twice = paths_;
  twice.push_back(paths_[3]);
  expectRefused(linkPacks(twice, folder_.path()), "scenes/kitchen.pack: is there twice");
  const auto second = [&](std::size_t n, const char* name) {
    auto more = paths_;
    more.push_back(at(name));
    fs::copy_file(paths_[n], more.back());
    return linkPacks(more, folder_.path());
  };
  expectRefused(second(2, "robot.pack"), "hold 2 robots and 1 episode sets, a world has at most");
  expectRefused(second(0, "tasks.pack"), "hold 1 robots and 2 episode sets, a world has at most");
  auto no_scene = paths_;
  no_scene.pop_back();
  expectRefused(linkPacks(no_scene, folder_.path()), "hold no scene");
  auto no_objects = paths_;
  no_objects.erase(no_objects.begin() + 1);
  expectRefused(linkPacks(no_objects, folder_.path()),
                "which the world, with 0 objects, does not have");
}

TEST_F(WorldPack, MayLackRobotEpisodesAndObjects) {
  for (const std::vector<std::size_t>& kept :
       {std::vector<std::size_t>{0, 1, 3}, {1, 2, 3}, {1, 3}, {2, 3}, {3}}) {
    std::vector<fs::path> some;
    for (const std::size_t n : kept) some.push_back(paths_[n]);
    const auto linked = linkPacks(some, folder_.path());
    ASSERT_TRUE(linked.has_value()) << linked.error().text();
    EXPECT_EQ(linked->size(), kept.size());
    ASSERT_TRUE(writeWorldPack(at("part.pack"), *linked, provenance()).has_value());
    // It is a pack like others, only that there is nothing to run.
    EXPECT_TRUE(PackFile::open(at("part.pack")).has_value());
    const auto world = World::open(std::vector{at("part.pack")});
    ASSERT_FALSE(world.has_value());
    EXPECT_THAT(world.error().message, HasSubstr("; give a pack of one, too"));
  }
}

TEST_F(WorldPack, RefusesAWorldAmongItsPacks) {
  const auto linked = linkPacks(paths_, folder_.path());
  ASSERT_TRUE(linked.has_value());
  ASSERT_TRUE(writeWorldPack(at("world.pack"), *linked, provenance()).has_value());
  auto more = paths_;
  more.push_back(at("world.pack"));
  expectRefused(linkPacks(more, folder_.path()), "world.pack: is a world");
}

TEST_F(WorldPack, RefusesPacksThatAreMissingOrBroken) {
  auto missing = paths_;
  missing[1] = at("none.pack");
  const auto no_file = linkPacks(missing, folder_.path());
  ASSERT_FALSE(no_file.has_value());
  EXPECT_EQ(no_file.error().code, ErrorCode::kIo);
  static_cast<void>(folder_.write("objects.pack", "no pack"));
  expectRefused(linkPacks(paths_, folder_.path()), "objects.pack");
}

/// The packs of a home whose kitchen shows a texture that it shares with other scenes.
class WorldPackWithTexture : public testing::Test {
 protected:
  void SetUp() override {
    WorldFields home = smallHomeWorldWithModels();
    RenderMeshesFields& meshes = *home.scene.render_meshes;
    meshes.textures = {{.name = "oak.png", .shared = hashOf(texture_.texels)}};
    meshes.texels.clear();
    meshes.materials[0].texture = 0;
    for (const ReferenceFields& one : writePacks(folder_, home).packs) {
      paths_.push_back(folder_.path() / one.path);
    }
    const auto [low, high] = hashOf(texture_.texels);
    name_ = fmt::format("textures/{:016x}{:016x}.pack", high, low);
  }
  /// Puts the texture's pack under this name.
  void writeTexture(const std::string& name) {
    static_cast<void>(folder_.write(name, textOf(buildPack(texture_))));
  }

  ScratchFolder folder_;
  TexturePackFields texture_;
  std::vector<fs::path> paths_;
  /// Where scenes in a folder beside look for it.
  std::string name_;
};

TEST_F(WorldPackWithTexture, ListsTheTexturePackBesideTheFolderOfTheScene) {
  writeTexture(name_);
  const auto linked = linkPacks(paths_, folder_.path());
  ASSERT_TRUE(linked.has_value()) << linked.error().text();
  ASSERT_EQ(linked->size(), paths_.size() + 1);
  EXPECT_EQ(linked->back().path, name_);
  EXPECT_EQ(linked->back().kind, PackKind::kTexture);
  const fs::path file = folder_.path() / "world.pack";
  ASSERT_TRUE(writeWorldPack(file, *linked, provenance()).has_value());
  const auto world = World::open(std::vector{file});
  ASSERT_TRUE(world.has_value()) << world.error().text();
  const auto models = WorldModels::from(*world);
  EXPECT_TRUE(models.has_value()) << models.error().text();
}

TEST_F(WorldPackWithTexture, ListsATexturePackThatIsGivenOnce) {
  writeTexture("oak.pack");
  paths_.push_back(folder_.path() / "oak.pack");
  const auto elsewhere = linkPacks(paths_, folder_.path());
  ASSERT_TRUE(elsewhere.has_value()) << elsewhere.error().message;
  EXPECT_EQ(elsewhere->size(), paths_.size());
  writeTexture(name_);
  paths_.back() = folder_.path() / name_;
  const auto where_it_belongs = linkPacks(paths_, folder_.path());
  ASSERT_TRUE(where_it_belongs.has_value()) << where_it_belongs.error().message;
  EXPECT_EQ(where_it_belongs->size(), paths_.size());
}

TEST_F(WorldPackWithTexture, IsNotMadeWithoutIt) {
  const auto linked = linkPacks(paths_, folder_.path());
  ASSERT_FALSE(linked.has_value());
  EXPECT_EQ(linked.error().code, ErrorCode::kIo);
  EXPECT_EQ(linked.error().where, (folder_.path() / "scenes/kitchen.pack").string());
  EXPECT_EQ(linked.error().message,
            fmt::format("shares the texture \"oak.png\", whose pack {} cannot be opened; put it "
                        "there, or give its path, too",
                        (folder_.path() / name_).string()));
}

TEST(WorldPackLists, HoldPathsBelowTheirFolderOnly) {
  const auto list_with = [](const std::string& path) {
    return std::vector<LinkedPack>{{.path = "e.pack", .kind = PackKind::kEpisodes},
                                   {.path = path, .kind = PackKind::kScene},
                                   {.path = "r.pack", .kind = PackKind::kRobot}};
  };
  for (const char* path : {"s.pack", "a/s.pack", "a..b/..s.pack", ".hidden/s.pack"}) {
    EXPECT_TRUE(encodeWorldPack(list_with(path), provenance()).has_value()) << path;
  }
  for (const char* path :
       {"", "/s.pack", "../s.pack", "a/../s.pack", "a//s.pack", "./s.pack", "a/./s.pack", "a/"}) {
    const auto payload = encodeWorldPack(list_with(path), provenance());
    ASSERT_FALSE(payload.has_value()) << path;
    EXPECT_EQ(payload.error().where, path);
    EXPECT_THAT(payload.error().message, HasSubstr("below its own folder"));
  }
}

}  // namespace
}  // namespace galactic::test::world_pack_test
