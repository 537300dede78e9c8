#include "dataset/scene_files.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>
#include <vector>

#include "support/scratch_folder.h"

namespace galactic::test::scene_files_test {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;

std::vector<std::string> found(const ScratchFolder& folder, const std::vector<std::string>& files) {
  for (const std::string& file : files) static_cast<void>(folder.write(file, "any content"));
  const auto scenes = bake::findSceneFiles(folder.path());
  EXPECT_TRUE(scenes) << scenes.error().message;
  std::vector<std::string> texts;
  if (!scenes) return texts;
  for (const bake::SceneFile& scene : *scenes) {
    texts.push_back(fmt::format("{}={}{}", scene.name,
                                scene.path.lexically_relative(folder.path()).string(),
                                scene.up == bake::UpAxis::kZ ? " Z" : ""));
  }
  return texts;
}

TEST(SceneFiles, OfMatterport3dAreInFoldersOfTheirName) {
  EXPECT_THAT(
      found(ScratchFolder(), {"17DRP5sb8fy/17DRP5sb8fy.glb", "17DRP5sb8fy/17DRP5sb8fy_semantic.ply",
                              "17DRP5sb8fy/17DRP5sb8fy.house", "17DRP5sb8fy/17DRP5sb8fy.navmesh",
                              "1LXtFkjw3qL/1LXtFkjw3qL.glb", "mp3d.scene_dataset_config.json"}),
      ElementsAre("17DRP5sb8fy=17DRP5sb8fy/17DRP5sb8fy.glb Z",
                  "1LXtFkjw3qL=1LXtFkjw3qL/1LXtFkjw3qL.glb Z"));
}

TEST(SceneFiles, OfHm3dAreTheBasisOnesOnlyWithoutPlainOnes) {
  EXPECT_THAT(found(ScratchFolder(), {"train/00000-kfPV7w3FaU5/kfPV7w3FaU5.basis.glb",
                                      "train/00000-kfPV7w3FaU5/kfPV7w3FaU5.glb",
                                      "train/00000-kfPV7w3FaU5/kfPV7w3FaU5.semantic.glb",
                                      "train/00000-kfPV7w3FaU5/kfPV7w3FaU5.basis.navmesh",
                                      "val/00800-TEEsavR23oF/TEEsavR23oF.basis.glb",
                                      "val/00800-TEEsavR23oF/TEEsavR23oF.semantic.txt"}),
              ElementsAre("kfPV7w3FaU5=train/00000-kfPV7w3FaU5/kfPV7w3FaU5.glb Z",
                          "TEEsavR23oF=val/00800-TEEsavR23oF/TEEsavR23oF.basis.glb Z"));
}

TEST(SceneFiles, OfGibsonLieSideBySide) {
  EXPECT_THAT(found(ScratchFolder(), {"Adrian.glb", "Adrian.navmesh", "Albertville.glb",
                                      ".hidden/Other.glb", "notes.txt"}),
              ElementsAre("Adrian=Adrian.glb Z", "Albertville=Albertville.glb Z"));
}

TEST(SceneFiles, AreNamedAfterTheirFoldersWhereTheirNamesSayLittle) {
  EXPECT_THAT(found(ScratchFolder(), {"office/mesh.ply", "flat/mesh.ply", "flat/mesh.obj"}),
              ElementsAre("flat=flat/mesh.ply", "office=office/mesh.ply"));
  EXPECT_THAT(found(ScratchFolder(), {"train/a/a.glb", "val/a/a.glb", "val/b/b.glb"}),
              ElementsAre("train_a=train/a/a.glb Z", "val_a=val/a/a.glb Z", "b=val/b/b.glb Z"));
  EXPECT_THAT(found(ScratchFolder(), {"a/a.glb", "a.glb"}),
              ElementsAre("a=a/a.glb Z", "a_2=a.glb Z"));
}

TEST(SceneFiles, OfNothingAreAnError) {
  const ScratchFolder folder;
  static_cast<void>(folder.write("readme.txt", "no scans"));
  const auto none = bake::findSceneFiles(folder.path());
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, ErrorCode::kInvalidInput);
  EXPECT_EQ(none.error().message,
            "there is no scene in it; expected SCENE/SCENE.glb, or *.glb, *.ply or *.obj files");
  const auto absent = bake::findSceneFiles(folder.path() / "absent");
  ASSERT_FALSE(absent);
  EXPECT_EQ(absent.error().code, ErrorCode::kIo);
}

TEST(SceneFiles, LeaveOutLinksToFoldersAndRefuseThoseThatLeadNowhere) {
  const ScratchFolder folder;
  static_cast<void>(folder.write("store/b/b.glb", "any content"));
  fs::create_directories(folder.path() / "scans");
  fs::create_directory_symlink("../store", folder.path() / "scans/more");
  fs::create_symlink("gone.navmesh", folder.path() / "scans/a.navmesh");
  fs::create_symlink("gone_semantic.ply", folder.path() / "scans/a_semantic.ply");
  static_cast<void>(folder.write("scans/a.glb", "any content"));
  const auto scenes = bake::findSceneFiles(folder.path() / "scans");
  ASSERT_TRUE(scenes) << scenes.error().message;
  ASSERT_EQ(scenes->size(), 1U);
  EXPECT_EQ(scenes->front().name, "a");
  fs::create_symlink("gone.glb", folder.path() / "scans/c.glb");
  const auto lost = bake::findSceneFiles(folder.path() / "scans");
  ASSERT_FALSE(lost);
  EXPECT_EQ(lost.error().code, ErrorCode::kIo);
  EXPECT_EQ(lost.error().where, (folder.path() / "scans/c.glb").string());
  EXPECT_EQ(lost.error().message,
            "is a link to gone.glb, which is not there or cannot be looked at; restore that file, "
            "or remove the link");
}

TEST(SceneFiles, OfAFolderThatCannotBeReadAreAnError) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may read everything";
  const ScratchFolder folder;
  static_cast<void>(folder.write("a/a.glb", "any content"));
  static_cast<void>(folder.write("b/b.glb", "any content"));
  fs::permissions(folder.path() / "b", fs::perms::none);
  const auto scenes = bake::findSceneFiles(folder.path());
  fs::permissions(folder.path() / "b", fs::perms::owner_all);
  ASSERT_FALSE(scenes);
  EXPECT_EQ(scenes.error().code, ErrorCode::kIo);
  EXPECT_EQ(scenes.error().where, (folder.path() / "b").string());
}

}  // namespace
}  // namespace galactic::test::scene_files_test
