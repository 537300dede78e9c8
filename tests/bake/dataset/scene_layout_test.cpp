// What a scene places, looked up before any mesh is read.
#include "dataset/scene_layout.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bake/dataset/small_dataset.h"

namespace galactic::test::scene_layout_test {
namespace {

using bake::DatasetIndex;
using bake::MotionType;
using bake::PlacedItem;
using bake::SceneInstance;
using bake::SceneItem;
using bake::TemplateKind;
using testing::ElementsAre;
using testing::IsEmpty;

DatasetIndex indexOf(const SmallDataset& small) {
  auto index = bake::readDatasetIndex(small.config(), /*allow_outside=*/false);
  EXPECT_TRUE(index) << index.error().text();
  return std::move(*index);
}

SceneItem itemOf(const std::string& name, MotionType motion = MotionType::kStatic) {
  SceneItem item;
  item.template_name = name;
  item.motion = motion;
  return item;
}

TEST(SceneLayout, ListsWhatIsPlacedByKindAndInOrder) {
  const SmallDataset small;
  const DatasetIndex index = indexOf(small);
  SceneInstance instance;
  instance.stage = itemOf("room");
  instance.articulated = {itemOf("cupboard", MotionType::kDynamic)};
  instance.objects = {itemOf("table"), itemOf("cup", MotionType::kDynamic), itemOf("table")};
  const auto layout = bake::layOutScene(index, instance);
  ASSERT_TRUE(layout) << layout.error().text();
  EXPECT_TRUE(layout->hasStage());
  std::vector<std::string> files;
  for (const PlacedItem& placed : layout->items) {
    files.push_back(placed.file.filename().string());
    EXPECT_TRUE(placed.file.is_absolute());
    EXPECT_THAT(placed.missing, IsEmpty());
    EXPECT_THAT(placed.absent, IsEmpty());
    EXPECT_EQ(placed.moves(), placed.item == &instance.objects[1]) << "furniture stays";
  }
  EXPECT_THAT(files, ElementsAre("room.obj", "box.obj", "box.obj", "box.obj", "cupboard.urdf"));
  EXPECT_EQ(layout->items[1].attributes, layout->items[3].attributes) << "read once";
}

TEST(SceneLayout, SaysOfEachItemWhatIsMissingAndWhereItWasLookedFor) {
  const SmallDataset small;
  const DatasetIndex index = indexOf(small);
  SceneInstance instance;
  instance.stage = itemOf("hall");
  instance.objects = {itemOf("ghost", MotionType::kDynamic)};
  const auto layout = bake::layOutScene(index, instance);
  ASSERT_TRUE(layout) << layout.error().text();
  EXPECT_FALSE(layout->hasStage());
  const PlacedItem& hall = layout->items[0];
  EXPECT_EQ(hall.entry, nullptr);
  EXPECT_EQ(hall.missing, "stage 'hall' is in none of the dataset's paths");
  EXPECT_THAT(hall.absent,
              ElementsAre(small.folder() / "configs/stages" / "hall.stage_config.json"));
  const PlacedItem& ghost = layout->items[1];
  EXPECT_TRUE(ghost.file.empty());
  EXPECT_EQ(ghost.missing, "object 'ghost': its mesh 'meshes/ghost.glb' is missing");
  EXPECT_THAT(ghost.absent, testing::SizeIs(1));
}

TEST(SceneLayout, OfASceneThatWantsNoStageHasNone) {
  const SmallDataset small;
  const DatasetIndex index = indexOf(small);
  const SceneInstance instance;
  const auto layout = bake::layOutScene(index, instance);
  ASSERT_TRUE(layout) << layout.error().text();
  EXPECT_FALSE(layout->hasStage());
  EXPECT_THAT(layout->items, IsEmpty());
}

}  // namespace
}  // namespace galactic::test::scene_layout_test
