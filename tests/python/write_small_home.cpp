// Writes the small home to a folder, and below it one that no simulator takes, one whose robot
// drives sideways, and one with strange names, for tests in another language.
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

/// A home whose robot drives sideways, too.
galactic::test::WorldFields sidewaysHome() {
  galactic::test::WorldFields home = galactic::test::smallHomeWorldWithModels();
  home.robot.base->sideways_step = 0.0625F;
  return home;
}

/// A home whose names are no UTF-8, as the names of files need not be: half of a surrogate pair, a
/// character that is longer than it has to be, one behind the last, and a lonely byte.
galactic::test::WorldFields strangeHome() {
  galactic::test::WorldFields home = galactic::test::smallHomeWorldWithModels();
  home.objects.objects[1].name = home.episodes.objects[1] = "mug \xED\xA0\x80";
  home.objects.render_meshes->semantics = {"thing \xE0\x80\x80"};
  home.robot.joint_names[4] = "wrist \xF4\x90\x80\x80";
  home.robot.link_names[3] = "arm \xFF";
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
    write(sidewaysHome(), fs::path(argv[1]) / "sideways");
    write(strangeHome(), fs::path(argv[1]) / "strange");
  } catch (const std::exception& problem) {
    std::fprintf(stderr, "%s\n", problem.what());
    return 4;
  }
  return 0;
}
