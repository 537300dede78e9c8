// One name for a scan or template, wherever it is named.
#include "galactic/bake/habitat_names.h"

#include <gtest/gtest.h>

namespace galactic::test::habitat_names_test {
namespace {

using bake::habitatName;

TEST(HabitatNames, LackTheFoldersAndTheEnding) {
  EXPECT_EQ(habitatName("configs/scenes/v3_sc1_staging_05.scene_instance.json"),
            "v3_sc1_staging_05");
  for (const char* file : {"mug.object_config.json", "mug.stage_config.json", "mug.ao_config.json",
                           "mug.json", "a/mug.basis.glb", "a\\mug.GLB", "mug.urdf", "mug"}) {
    EXPECT_EQ(habitatName(file), "mug") << file;
  }
}

TEST(HabitatNames, KeepDotsThatBeginNoEnding) {
  EXPECT_EQ(habitatName("a.b.object_config.json"), "a.b");
  EXPECT_EQ(habitatName("v1.5"), "v1.5");
  EXPECT_EQ(habitatName("mug.off"), "mug.off");
  EXPECT_EQ(habitatName("mug.off", ".off"), "mug");
  EXPECT_EQ(habitatName("mug.basis.glb", ".glb"), "mug");
  EXPECT_EQ(habitatName(".glb", ".glb"), ".glb") << "a name is never empty";
}

}  // namespace
}  // namespace galactic::test::habitat_names_test
