#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "support/build_paths.h"
#include "support/file_content.h"
#include "support/homes/small_home.h"
#include "support/program_run.h"
#include "support/scratch_folder.h"

namespace galactic::test {

/// A folder with the small home as world.pack, in which galactic-run works.
class SimulationFolder : public testing::Test {
 protected:
  void SetUp() override { writeWorld(test::smallHomeWorld()); }

  void writeWorld(const WorldFields& world) {
    ASSERT_TRUE(std::filesystem::exists(test::writeWorld(folder_, world)));
  }
  [[nodiscard]] ProgramRun runBare(std::vector<std::string> arguments) const {
    return test::runProgram(test::builtProgram("galactic-run"), folder_.path(),
                            std::move(arguments));
  }
  /// Until a run that was started has tried its files, which are empty then, and records.
  void waitForRecording() const {
    const auto records = [&] {
      const std::filesystem::directory_iterator files(folder_.path());
      return std::any_of(begin(files), end(files), [](const auto& file) {
        std::error_code gone;
        return file.path().filename().string().starts_with("run.rec.part-") &&
               file.file_size(gone) > 0 && !gone;
      });
    };
    for (int n = 0; n < 2000 && !records(); ++n) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  }
  /// With the world.
  [[nodiscard]] ProgramRun run(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), {"world.pack"});
    return runBare(std::move(arguments));
  }
  /// Simulates with a report and returns it.
  [[nodiscard]] nlohmann::json reportOf(std::vector<std::string> arguments) const {
    arguments.insert(arguments.end(), {"--report", "report.json"});
    const ProgramRun result = run(std::move(arguments));
    EXPECT_EQ(result.exit_code, 0) << result.err;
    nlohmann::json report = nlohmann::json::parse(content("report.json"), nullptr, false);
    EXPECT_TRUE(report.is_object()) << content("report.json");
    return report;
  }
  [[nodiscard]] std::string content(const std::string& name) const {
    return test::fileContent(folder_.path() / name);
  }
  [[nodiscard]] std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
      names.push_back(entry.path().filename().string());
    }
    return names;
  }
  /// Records 40 steps of 5 envs.
  void record() const {
    const ProgramRun result = run({"--envs", "5", "--steps", "40", "--seed", "9", "--episode-steps",
                                   "15", "--safe-drop", "--threads", "1", "--record", "run.rec"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
  }

  test::ScratchFolder folder_;
};

}  // namespace galactic::test
