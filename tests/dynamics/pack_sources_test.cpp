// Whether sources are what packs were baked from, and what stands for the content of those read.
#include "dynamics/sources/pack_sources.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "galactic/bake/read_files.h"
#include "support/homes/small_home.h"
#include "support/scratch_folder.h"

namespace galactic::test::pack_sources_test {
namespace {

using bake::SourceFile;
using dynamics::AssetSources;
using dynamics::digestOf;
using dynamics::PackSources;
using testing::ElementsAre;
using testing::IsEmpty;

/// What the small home's packs list: of its robot as it is, of its objects below no object's name.
const SourceFile kListed{.name = "input.obj", .bytes = 1234, .hash_low = 1, .hash_high = 2};

SourceFile named(const std::string& name, const SourceFile& content = kListed) {
  SourceFile file = content;
  file.name = name;
  return file;
}

class SourcesOfPacks : public testing::Test {
 protected:
  SourcesOfPacks() : path_(writeWorld(folder_, smallHomeWorld())) {}

  [[nodiscard]] std::vector<std::string> differences(const AssetSources& now) const {
    return PackSources(world_).differences(now).value();
  }
  [[nodiscard]] AssetSources robot(std::vector<SourceFile> files) const {
    return {.kind = PackKind::kRobot, .name = world_.robot().name(), .files = std::move(files)};
  }

  ScratchFolder folder_;
  std::filesystem::path path_;
  World world_ = World::open(std::span(&path_, 1)).value();
};

TEST_F(SourcesOfPacks, AreTheSameWhereTheirContentIs) {
  EXPECT_THAT(differences(robot({kListed})), IsEmpty());
  EXPECT_THAT(differences(robot({})), IsEmpty());
  // It lies elsewhere now, as the packages of a URDF may.
  EXPECT_THAT(differences(robot({named("../elsewhere/input.obj")})), IsEmpty());
}

TEST_F(SourcesOfPacks, DifferByContentAndByName) {
  const std::string name(world_.robot().name());
  SourceFile changed = kListed;
  changed.hash_low = 3;
  EXPECT_THAT(differences(robot({changed})),
              ElementsAre("robot '" + name +
                          "' was baked from another 'input.obj' than is there now; bake the world "
                          "again"));
  EXPECT_THAT(differences(robot({kListed, named("hand.stl", changed)})),
              ElementsAre("robot '" + name +
                          "' was baked without 'hand.stl', which belongs to it now; bake the world "
                          "again"));
  AssetSources with_recipe = robot({kListed});
  with_recipe.named = {folder_.write("robot.toml", "name = \"other\""), {}};
  EXPECT_THAT(differences(with_recipe),
              ElementsAre("robot '" + name +
                          "' was baked without 'robot.toml', which belongs to it now; bake the "
                          "world again"));
}

TEST_F(SourcesOfPacks, SayNothingOfWhatNoPackHolds) {
  EXPECT_THAT(differences({.kind = PackKind::kObjects, .name = "none", .files = {named("a.obj")}}),
              IsEmpty());
  EXPECT_THAT(PackSources(world_).listed(PackKind::kObjects, "none"), IsEmpty());
}

TEST(ADigestOfSources, ChangesWithEachContentAndPath) {
  const auto digest = [](const std::vector<std::pair<std::string_view, SourceFile>>& files) {
    bake::ReadLog log;
    for (const auto& [folder, file] : files) log.note(folder, {.files = {file}});
    return digestOf(log);
  };
  SourceFile other = kListed;
  other.hash_high = 3;
  const SourceFile second = named("second.obj", other);
  const std::string both = digest({{"a", kListed}, {"a", second}});
  // The order and the number of times do not count.
  EXPECT_EQ(digest({{"a", second}, {"a", kListed}, {"a/../a", second}}), both);
  EXPECT_NE(digest({{"a", kListed}}), both);
  EXPECT_NE(digest({{"a", kListed}, {"b", second}}), both);
  // Two files that change places are others.
  EXPECT_NE(digest({{"a", named("second.obj")}, {"a", named("input.obj", other)}}), both);
}

TEST(ADigestOfSources, LeavesOutWhatIsNotRead) {
  bake::ReadLog log;
  const std::string nothing = digestOf(log);
  log.noteRead("named/by/the/recipe.glb");
  log.noteAbsent("looked/for.json");
  EXPECT_EQ(digestOf(log), nothing);
}

}  // namespace
}  // namespace galactic::test::pack_sources_test
