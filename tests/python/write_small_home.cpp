// Writes the small home to a folder, for tests in another language.
#include <cstdio>
#include <exception>
#include <filesystem>

#include "support/homes/small_home_models.h"
#include "support/scratch_folder.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: python_test_world FOLDER\n", stderr);
    return 1;
  }
  try {
    const galactic::test::ScratchFolder scratch;
    const std::filesystem::path world =
        galactic::test::writeWorld(scratch, galactic::test::smallHomeWorldWithModels());
    std::filesystem::create_directories(argv[1]);
    std::filesystem::copy(world.parent_path(), argv[1],
                          std::filesystem::copy_options::overwrite_existing |
                              std::filesystem::copy_options::recursive);
    std::filesystem::rename(std::filesystem::path(argv[1]) / world.filename(),
                            std::filesystem::path(argv[1]) / "world.pack");
  } catch (const std::exception& problem) {
    std::fprintf(stderr, "%s\n", problem.what());
    return 4;
  }
  return 0;
}
