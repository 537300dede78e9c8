#pragma once
#include <cstdlib>
#include <filesystem>

#include "support/build_paths.h"

namespace galactic::test {

/// Folder of real scenes to test on: GALACTIC_ASSETS, else "../shared/assets" beside the project.
/// Empty when neither is there; tests then say that they skip.
inline std::filesystem::path assetsFolder() {
  if (const char* folder = std::getenv("GALACTIC_ASSETS")) return folder;
  const std::filesystem::path beside = test::sourceFolder().parent_path() / "shared" / "assets";
  return std::filesystem::is_directory(beside) ? beside : std::filesystem::path();
}

}  // namespace galactic::test
