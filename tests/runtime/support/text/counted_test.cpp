#include "support/text/counted.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace galactic::counted_test {
namespace {

TEST(Counted, IsOneOrMany) {
  EXPECT_EQ(counted(1, "scene"), "1 scene");
  EXPECT_EQ(counted(0, "scene"), "0 scenes");
  EXPECT_EQ(counted(std::uint64_t{1} << 40, "step"), "1099511627776 steps");
  EXPECT_EQ(counted(2, "joint position"), "2 joint positions");
}

TEST(Counted, PutsAnEBetweenSoundsThatHiss) {
  EXPECT_EQ(counted(2, "success"), "2 successes");
  EXPECT_EQ(counted(2, "box"), "2 boxes");
  EXPECT_EQ(counted(2, "patch"), "2 patches");
  EXPECT_EQ(counted(2, "mesh"), "2 meshes");
  EXPECT_EQ(counted(1, "mesh"), "1 mesh");
}

TEST(Counted, KnowsTheVertices) {
  EXPECT_EQ(counted(1, "vertex"), "1 vertex");
  EXPECT_EQ(counted(3, "vertex"), "3 vertices");
}

}  // namespace
}  // namespace galactic::counted_test
