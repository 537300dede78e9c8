// Writes the small home to a folder, and one that no simulator takes below it, for tests in another
// language.
#include <cstdio>
#include <exception>
#include <filesystem>

#include "support/homes/small_home_models.h"
#include "support/scratch_folder.h"

namespace {

namespace fs = std::filesystem;

/// The packs in `folder`, the world's as world.pack.
void write(const galactic::test::WorldFields& fields, const fs::path& folder) {
  const galactic::test::ScratchFolder scratch;
  const fs::path world = galactic::test::writeWorld(scratch, fields);
  fs::create_directories(folder);
  fs::copy(world.parent_path(), folder,
           fs::copy_options::overwrite_existing | fs::copy_options::recursive);
  fs::rename(folder / world.filename(), folder / "world.pack");
}

/// A home whose robot's wrist is a planar joint, of which an action moves the second position;
/// another action moves a position that no joint takes. A valid pack, of which no simulator is
/// made.
galactic::test::WorldFields planarHome() {
  galactic::test::WorldFields home = galactic::test::smallHomeWorldWithModels();
  home.robot.links[4].type = galactic::JointType::kPlanar;
  home.robot.limits.resize(7, {-1, 1});
  home.robot.start_positions.resize(7);
  home.robot.controlled_joints[3].position = 4;
  home.robot.controlled_joints.push_back({6, 0.1F, -1, 1});
  return home;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: python_test_world FOLDER\n", stderr);
    return 1;
  }
  try {
    write(galactic::test::smallHomeWorldWithModels(), argv[1]);
    write(planarHome(), fs::path(argv[1]) / "planar");
  } catch (const std::exception& problem) {
    std::fprintf(stderr, "%s\n", problem.what());
    return 4;
  }
  return 0;
}
