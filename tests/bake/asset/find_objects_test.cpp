// Which objects are found in folders.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <string>
#include <vector>

#include "galactic/bake/assets.h"
#include "support/scratch_folder.h"

namespace galactic::test::find_objects_test {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

class FindObjects : public testing::Test {
 protected:
  void write(const std::vector<std::string>& files) const {
    for (const std::string& file : files) static_cast<void>(folder_.write(file, "any content"));
  }
  [[nodiscard]] fs::path path(const std::string& name) const { return folder_.path() / name; }
  /// The objects of inputs, as NAME=FILE below `set`; warnings come behind them.
  [[nodiscard]] std::vector<std::string> foundIn(const std::vector<fs::path>& inputs) const {
    auto found = bake::findObjects(inputs);
    EXPECT_TRUE(found) << found.error().text();
    std::vector<std::string> texts;
    if (!found) return texts;
    for (const bake::ObjectInput& object : found->objects) {
      texts.push_back(fmt::format("{}={}", object.name,
                                  object.path.lexically_relative(path("set")).generic_string()));
    }
    std::ranges::move(found->warnings, std::back_inserter(texts));
    return texts;
  }
  [[nodiscard]] std::vector<std::string> found() const { return foundIn({path("set")}); }
  [[nodiscard]] Error refused() const {
    const auto found = bake::findObjects({path("set")});
    EXPECT_FALSE(found);
    return found ? Error{} : found.error();
  }

 private:
  ScratchFolder folder_;
};

TEST_F(FindObjects, PassesOverHiddenFilesAndFolders) {
  write({"set/mug.glb", "set/._mug.glb", "set/.thumbnails/mug.glb", "set/can/._model.obj",
         "set/can/model.obj"});
  EXPECT_THAT(found(), ElementsAre("can=can/model.obj", "mug=mug.glb"));
}

TEST_F(FindObjects, FollowsLinksToFolders) {
  write({"store/can/model.obj", "store/cups/cup.glb", "set/mug.glb"});
  fs::create_directory_symlink("../store", path("set/more"));
  EXPECT_THAT(found(),
              ElementsAre("can=more/can/model.obj", "cup=more/cups/cup.glb", "mug=mug.glb"));
  // The input itself may be one, too.
  fs::rename(path("set"), path("real"));
  fs::create_directory_symlink("real", path("set"));
  EXPECT_THAT(found(),
              ElementsAre("can=more/can/model.obj", "cup=more/cups/cup.glb", "mug=mug.glb"));
}

TEST_F(FindObjects, SearchesEachFolderOnceWhateverLinksLeadToIt) {
  write({"set/v2/can/model.obj", "set/v2/mug.glb", "outer.glb"});
  // Under its own name, though the link comes first.
  fs::create_directory_symlink("v2", path("set/latest"));
  fs::create_directory_symlink("can", path("set/v2/again"));
  fs::create_directory_symlink("../..", path("set/v2/out"));
  fs::create_directory_symlink("../set", path("set/around"));
  EXPECT_THAT(found(), ElementsAre("can=v2/can/model.obj", "mug=v2/mug.glb"));
}

TEST_F(FindObjects, RefusesALinkWithAMeshsNameThatLeadsNowhere) {
  write({"set/mug.glb"});
  fs::create_symlink("../store/notes.txt", path("set/notes.txt"));
  EXPECT_THAT(found(), ElementsAre("mug=mug.glb"));
  fs::create_symlink("../store/can.obj", path("set/can.obj"));
  EXPECT_EQ(refused().code, ErrorCode::kIo);
  EXPECT_EQ(refused().where, path("set/can.obj").string());
  EXPECT_EQ(
      refused().message,
      "is a link to ../store/can.obj, which is not there or cannot be looked at; restore that "
      "file, or remove the link");
  write({"store/can.obj"});
  EXPECT_THAT(found(), ElementsAre("can=can.obj", "mug=mug.glb"));
}

TEST_F(FindObjects, RefusesAFolderThatCannotBeRead) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may read everything";
  write({"set/mug.glb", "set/cups/cup.glb"});
  fs::permissions(path("set/cups"), fs::perms::none);
  EXPECT_EQ(refused().code, ErrorCode::kIo);
  EXPECT_EQ(refused().where, path("set/cups").string());
  EXPECT_THAT(refused().message, HasSubstr("the folder cannot be read: "));
  fs::permissions(path("set/cups"), fs::perms::owner_all);
}

TEST_F(FindObjects, TakesTheVisualMeshOfGazebosPairs) {
  write({"set/chair/meshes/chair_visual.DAE", "set/chair/meshes/chair_collision.DAE",
         "set/desk/desk_visual.dae", "set/lamp/lamp_collision.dae", "set/sofa/sofa.glb",
         "set/sofa/sofa_visual.dae", "set/sofa/sofa_collision.dae"});
  EXPECT_THAT(found(), ElementsAre("chair=chair/meshes/chair_visual.DAE",
                                   // Of those that are no pairs nothing is known.
                                   "desk_visual=desk/desk_visual.dae",
                                   "lamp_collision=lamp/lamp_collision.dae", "sofa=sofa/sofa.glb",
                                   "sofa_collision=sofa/sofa_collision.dae",
                                   "sofa_visual=sofa/sofa_visual.dae"));
}

TEST_F(FindObjects, NamesAFolderWithOneModelByThatFolder) {
  write({"set/model.obj", "set/model.stl", "set/model_collision_0.obj", "set/textured.ply",
         "set/nontextured.ply", "set/parts/handle.glb"});
  EXPECT_THAT(found(), ElementsAre("handle=parts/handle.glb", "set=model.obj"));
}

TEST_F(FindObjects, TakesAllObjectsOfAnInputOneOfWhichIsCalledModel) {
  write({"set/model.glb", "set/model.stl", "set/mug.glb", "set/bowl.glb"});
  EXPECT_THAT(found(), ElementsAre("bowl=bowl.glb", "model=model.glb", "mug=mug.glb"));
}

TEST_F(FindObjects, WarnsOfMeshesThatTheModelOfTheirFolderHides) {
  write({"set/can/model.glb", "set/can/lid.glb", "set/can/handle.stl", "set/can/model.stl"});
  constexpr const char* kWarning =
      "can/model.glb stands for all of its folder, and {} beside it are left out: what is an "
      "object of its own needs a folder without such a file";
  EXPECT_THAT(found(),
              ElementsAre("can=can/model.glb", fmt::format(kWarning, "lid.glb, handle.stl")));
  for (int n = 0; n < 6; ++n) write({fmt::format("set/can/{}.glb", n)});
  EXPECT_THAT(found(), ElementsAre("can=can/model.glb",
                                   fmt::format(kWarning,
                                               "0.glb, 1.glb, 2.glb, 3.glb, 4.glb, 5.glb and 2 "
                                               "more")));
}

TEST_F(FindObjects, SaysNothingOfTheFormsInWhichCollectionsArePublished) {
  write({"set/002_can/google_16k/textured.obj", "set/002_can/google_16k/nontextured.ply",
         "set/002_can/google_16k/nontextured.stl", "set/002_can/tsdf/textured.obj",
         "set/002_can/tsdf/nontextured.ply", "set/003_box/textured.obj",
         "set/003_box/textured_simple.obj", "set/003_box/collision.ply",
         "set/003_box/textured.obj.coacd.ply", "set/Mug/meshes/model.obj", "set/Pot/model.obj",
         "set/Pot/model_collision_0.obj", "set/Pot/model_collision_1.obj"});
  EXPECT_THAT(found(),
              ElementsAre("002_can=002_can/google_16k/textured.obj", "003_box=003_box/textured.obj",
                          "Mug=Mug/meshes/model.obj", "Pot=Pot/model.obj"));
}

TEST_F(FindObjects, NamesFilesAsTheirFolderWouldBeNamed) {
  const std::vector<std::string> files{"002_can/google_16k/textured.obj",
                                       "003_box/google_16k/textured.obj", "red/model.obj",
                                       "mug.glb"};
  for (const std::string& file : files) write({"set/" + file});
  const std::vector<std::string> names{"002_can", "003_box", "red", "mug"};
  std::vector<fs::path> inputs;
  std::vector<std::string> all;
  for (std::size_t n = 0; n < files.size(); ++n) {
    inputs.push_back(path("set/" + files[n]));
    all.push_back(names[n] + "=" + files[n]);
    // Alone, too: another file may join it later.
    EXPECT_THAT(foundIn({inputs.back()}), ElementsAre(all.back()));
  }
  EXPECT_THAT(foundIn(inputs), testing::UnorderedElementsAreArray(all));
  EXPECT_THAT(found(), testing::UnorderedElementsAreArray(all));
}

TEST_F(FindObjects, CallsAModelInTheUppermostFolderByItsStem) {
  const auto found = bake::findObjects({"/model.obj", "/google_16k/textured.obj"});
  ASSERT_TRUE(found);
  ASSERT_EQ(found->objects.size(), 2U);
  EXPECT_EQ(found->objects[0].name, "model");
  EXPECT_EQ(found->objects[1].name, "textured");
}

}  // namespace
}  // namespace galactic::test::find_objects_test
