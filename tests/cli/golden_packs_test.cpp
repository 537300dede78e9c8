// The packs in packs/golden are what galactic-bake makes, byte for byte, on any machine.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "galactic/kinematics.h"
#include "galactic/object_set.h"
#include "galactic/pack.h"
#include "galactic/robot.h"
#include "galactic/scene.h"
#include "support/build_paths.h"
#include "support/file_content.h"
#include "support/program_run.h"
#include "support/scratch_folder.h"

namespace galactic::golden_packs_test {
namespace {

const std::filesystem::path& goldenFolder() {
  static const std::filesystem::path folder = test::sourceFolder() / "packs" / "golden";
  return folder;
}

/// Bakes golden inputs again, with the first one's name on the pack, and returns the bytes.
std::string bakeAgain(const std::vector<std::string>& inputs, std::vector<std::string> arguments) {
  const test::ScratchFolder folder;
  for (const std::string& input : inputs) {
    std::filesystem::copy_file(goldenFolder() / input, folder.path() / input);
  }
  arguments.insert(arguments.begin(), inputs.front());
  arguments.insert(arguments.end(), {"-o", "again.pack"});
  const test::ProgramRun run =
      test::runProgram(test::builtProgram("galactic-bake"), folder.path(), arguments);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  return test::fileContent(folder.path() / "again.pack");
}

std::string bakeRoom(std::vector<std::string> more_options) {
  std::vector<std::string> arguments{"--radii", "0.05,0.12",       "--spacing",
                                     "0.06",    "--check-columns", "0"};
  arguments.insert(arguments.end(), more_options.begin(), more_options.end());
  return bakeAgain({"room.obj"}, std::move(arguments));
}

TEST(GoldenPacks, AreMadeAgainByteForByte) {
  EXPECT_TRUE(bakeRoom({}) == test::fileContent(goldenFolder() / "room-column.pack"))
      << "the bytes of a bake changed: if on purpose, see packs/golden/README.md";
  EXPECT_TRUE(bakeRoom({"--coverage", "cell", "--threads", "3"}) ==
              test::fileContent(goldenFolder() / "room-cell.pack"))
      << "the bytes of a conservative bake changed: if on purpose, see packs/golden/README.md";
}

TEST(GoldenPacks, OfTheCrateAndTheArmAreMadeAgainByteForByte) {
  for (const char* threads : {"1", "3"}) {
    EXPECT_TRUE(bakeAgain({"crate.obj"}, {"--as", "object", "-j", threads}) ==
                test::fileContent(goldenFolder() / "crate.pack"))
        << "the bytes of an object changed: if on purpose, see packs/golden/README.md";
    EXPECT_TRUE(bakeAgain({"arm.urdf", "arm.toml"},
                          {"--recipe", "arm.toml", "--radii", "0.02,0.04", "-j", threads}) ==
                test::fileContent(goldenFolder() / "arm.pack"))
        << "the bytes of a robot changed: if on purpose, see packs/golden/README.md";
  }
}

TEST(GoldenPacks, ShowTheCrateAsItIsBuilt) {
  const auto pack = PackFile::open(goldenFolder() / "crate.pack");
  ASSERT_TRUE(pack) << pack.error().text();
  const auto set = ObjectSet::from(*pack);
  ASSERT_TRUE(set);
  ASSERT_EQ(set->find("crate"), 0U);
  const ObjectModel& crate = set->objects()[0];
  // 16 x 10 x 10 cm with its handle; boxes are grown by micrometers.
  constexpr float kGrowth = 1e-5F;
  EXPECT_NEAR(crate.box.half_extents.x, 0.08F, kGrowth);
  EXPECT_NEAR(crate.box.half_extents.y, 0.05F, kGrowth);
  EXPECT_NEAR(crate.box.half_extents.z, 0.05F, kGrowth);
  EXPECT_NEAR(crate.box.pose.translation.y, 0.05F, kGrowth);
  for (const SetSphere& sphere : crate.spheres) {
    EXPECT_GE(sphere.center.y, set->radii()[sphere.radius_index] - kGrowth) << "above the floor";
  }
  // It rests likeliest on its floor, as it stands in the file.
  EXPECT_NEAR(crate.stable_poses[0].height, 0, kGrowth);
  EXPECT_NEAR(crate.stable_poses[0].rotation.w, 1, kGrowth);
}

TEST(GoldenPacks, OfACrateWithoutHullPlanesStillLoad) {
  const auto older = PackFile::open(goldenFolder() / "crate-older.pack");
  ASSERT_TRUE(older) << older.error().text();
  const auto now = PackFile::open(goldenFolder() / "crate.pack");
  ASSERT_TRUE(now);
  const ObjectModel before = ObjectSet::from(*older).value().objects()[0];
  const ObjectModel after = ObjectSet::from(*now).value().objects()[0];
  EXPECT_TRUE(before.hull_planes.empty());
  // The handle leaves most of the box's top free.
  EXPECT_FALSE(after.hull_planes.empty());
  EXPECT_EQ(before.box, after.box);
  EXPECT_EQ(before.spheres.size(), after.spheres.size());
}

TEST(GoldenPacks, MoveTheArmAsItIsBuilt) {
  const auto pack = PackFile::open(goldenFolder() / "arm.pack");
  ASSERT_TRUE(pack) << pack.error().text();
  const auto robot = Robot::from(*pack);
  ASSERT_TRUE(robot);
  ASSERT_EQ(robot->positionCount(), 3U);
  EXPECT_THAT(robot->startPositions(), testing::ElementsAre(0, 0.5F, 0.01F));
  const auto left = robot->findLink("finger_left");
  const auto right = robot->findLink("finger_right");
  ASSERT_TRUE(left && right);
  // A quarter turn of the column to the left, the boom level, the fingers open by 2 cm each.
  const std::vector<float> positions{1.57079633F, -0.25F, 0.02F};
  std::vector<Pose> poses(robot->links().size());
  forwardKinematics(robot->links(), {}, positions, poses);
  constexpr float kRounding = 1e-6F;
  for (const auto& [link, side] : {std::pair(*left, 1.F), std::pair(*right, -1.F)}) {
    // Left is -Z: a turn to the left takes X there, and the boom's left to -X.
    EXPECT_NEAR(poses[link].translation.x, -0.03F * side, kRounding);
    EXPECT_NEAR(poses[link].translation.y, 0.2F, kRounding);
    EXPECT_NEAR(poses[link].translation.z, -0.19F, kRounding);
  }
}

TEST(GoldenPacks, AnswerAsTheRoomIsBuilt) {
  for (const char* name : {"room-column.pack", "room-cell.pack"}) {
    SCOPED_TRACE(name);
    const auto pack = PackFile::open(goldenFolder() / name);
    ASSERT_TRUE(pack) << pack.error().message;
    const auto scene = Scene::from(*pack);
    ASSERT_TRUE(scene);
    const auto index = scene->gridIndex(0.05F);
    ASSERT_TRUE(index);
    const ColumnGrid& grid = scene->grids()[*index];
    // Above the table, whose top is at 0.479 m, up to the ceiling at 1.107 m.
    const Contact above = grid.contact({0.49F, 0.8F, 0.5F});
    EXPECT_EQ(above.clearance, Clearance::kFree);
    constexpr float kStorage = 1e-4F;
    EXPECT_NEAR(above.down, 0.8F - 0.529F, kStorage);
    EXPECT_NEAR(above.up, 1.057F - 0.8F, kStorage);
    EXPECT_EQ(grid.clearance({0.49F, 0.46F, 0.5F}), Clearance::kBlocked);
    EXPECT_EQ(grid.clearance({5, 0.5F, 0.5F}), Clearance::kOutside);
  }
}

}  // namespace
}  // namespace galactic::golden_packs_test
