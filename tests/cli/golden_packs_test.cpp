// The packs in packs/golden are what galactic-bake makes, byte for byte, on any machine.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "galactic/pack.h"
#include "galactic/scene.h"
#include "support/program_run.h"
#include "support/scratch_folder.h"

namespace galactic {
namespace {

const std::filesystem::path& goldenFolder() {
  static const std::filesystem::path folder =
      std::filesystem::path(GALACTIC_SOURCE_DIR) / "packs" / "golden";
  return folder;
}

/// Bakes the golden room again and returns the bytes.
std::string bakeRoom(std::vector<std::string> more_options) {
  const test::ScratchFolder folder;
  std::filesystem::copy_file(goldenFolder() / "room.obj", folder.path() / "room.obj");
  std::vector<std::string> arguments{"room.obj", "--radii", "0.05,0.12", "--spacing",
                                     "0.06",     "-o",      "room.pack", "--check-columns",
                                     "0"};
  arguments.insert(arguments.end(), more_options.begin(), more_options.end());
  const test::ProgramRun run = test::runProgram(GALACTIC_BAKE, folder.path(), arguments);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  return test::fileContent(folder.path() / "room.pack");
}

TEST(GoldenPacks, AreMadeAgainByteForByte) {
  EXPECT_TRUE(bakeRoom({}) == test::fileContent(goldenFolder() / "room-column.pack"))
      << "the bytes of a bake changed: if on purpose, see packs/golden/README.md";
  EXPECT_TRUE(bakeRoom({"--coverage", "cell", "--jobs", "3"}) ==
              test::fileContent(goldenFolder() / "room-cell.pack"))
      << "the bytes of a conservative bake changed: if on purpose, see packs/golden/README.md";
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
}  // namespace galactic
