#include <cstdio>

#include "galactic/pack.h"
#include "galactic/scene.h"
#include "galactic/version.h"

int main(int, char** argv) {
  const auto pack = galactic::PackFile::open(argv[1]);
  const auto scene = pack ? galactic::Scene::from(*pack) : tl::unexpected(pack.error());
  if (!scene) return std::fprintf(stderr, "%s\n", scene.error().message.c_str()), 3;
  std::printf("%zu grids, galactic %d.%d.%d\n", scene->grids().size(), GALACTIC_VERSION_MAJOR,
              GALACTIC_VERSION_MINOR, GALACTIC_VERSION_PATCH);
}
