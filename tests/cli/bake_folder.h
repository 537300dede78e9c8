#pragma once
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "support/build_paths.h"
#include "support/file_content.h"
#include "support/program_run.h"
#include "support/scratch_folder.h"

namespace galactic::test {

/// A folder of its own for each test, in which galactic-bake runs.
class BakeFolder : public testing::Test {
 protected:
  void write(const std::string& name, std::string_view content) {
    ASSERT_EQ(fileContent(folder_.write(name, content)), content);
  }
  [[nodiscard]] ProgramRun run(std::vector<std::string> arguments) const {
    return runProgram(builtProgram("galactic-bake"), folder_.path(), std::move(arguments));
  }
  [[nodiscard]] bool has(const std::string& name) const {
    return std::filesystem::exists(folder_.path() / name);
  }
  [[nodiscard]] std::string content(const std::string& name) const {
    return fileContent(folder_.path() / name);
  }
  [[nodiscard]] std::filesystem::path path(const std::string& name) const {
    return folder_.path() / name;
  }

 private:
  ScratchFolder folder_;
};

/// A command line, its exit code and a part of what it says.
struct Refusal {
  std::vector<std::string> arguments;
  int exit_code;
  std::string part;
};

}  // namespace galactic::test
