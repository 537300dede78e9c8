#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "support/scratch_folder.h"

namespace galactic::test {

/// A folder for pictures, and a PATH on which this test decides what there is.
class PictureFolder : public testing::Test {
 protected:
  void SetUp() override {
    path_before_ = std::getenv("PATH");
    usePath(folder_.path().string() + "/bin:/usr/bin:/bin");
  }
  void TearDown() override { usePath(path_before_); }

  static void usePath(const std::string& path) { ::setenv("PATH", path.c_str(), 1); }

  /// A program "ffmpeg" of these shell commands.
  void fakeFfmpeg(const std::string& commands) const {
    const auto file = folder_.write("bin/ffmpeg", "#!/bin/sh\n" + commands);
    std::filesystem::permissions(file, std::filesystem::perms::owner_all);
  }
  /// One that keeps its arguments and what it is sent.
  void keepingFfmpeg() const {
    fakeFfmpeg("for last; do :; done\necho \"$@\" > '" + file("arguments") +
               "'\ncat > \"$last\"\n");
  }

  [[nodiscard]] std::string file(const std::string& name) const {
    return (folder_.path() / name).string();
  }
  [[nodiscard]] std::vector<std::string> files(const std::string& folder) const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path() / folder)) {
      names.push_back(entry.path().filename().string());
    }
    std::sort(names.begin(), names.end());
    return names;
  }

  ScratchFolder folder_;
  std::string path_before_;
};

}  // namespace galactic::test
