// Datasets of which many scenes are baked in one run.
#include "dataset/dataset_library.h"

#include <gtest/gtest.h>

#include "small_dataset.h"

namespace galactic::test::dataset_library_test {
namespace {

TEST(DatasetLibrary, ReadsADatasetOnceForEachReach) {
  const SmallDataset small;
  bake::DatasetLibrary library;
  const auto first = library.open(small.config(), {});
  ASSERT_TRUE(first) << first.error().text();
  EXPECT_EQ((*first)->scenes.scenes().front(), "a_home");
  const auto wide = library.open(small.config(), {.allow_outside = true});
  ASSERT_TRUE(wide) << wide.error().text();
  EXPECT_NE(*wide, *first);
  small.write("home.scene_dataset_config.json", "spoilt");
  const auto again = library.open(small.config(), {});
  ASSERT_TRUE(again) << again.error().text();
  EXPECT_EQ(*again, *first);
}

TEST(DatasetLibrary, ReadsAgainWhatCouldNotBeRead) {
  const SmallDataset small;
  small.write("home.scene_dataset_config.json", "spoilt");
  bake::DatasetLibrary library;
  ASSERT_FALSE(library.open(small.config(), {}));
  small.write("home.scene_dataset_config.json", SmallDataset::kConfig);
  EXPECT_TRUE(library.open(small.config(), {}));
}

}  // namespace
}  // namespace galactic::test::dataset_library_test
