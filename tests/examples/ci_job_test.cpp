// The CI job of examples/ci/ on this project's sample world.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <sstream>

#include "support/build_paths.h"
#include "support/file_content.h"
#include "support/program_run.h"
#include "support/scratch_folder.h"

namespace galactic::test::ci_job_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class CiJob : public testing::Test {
 protected:
  /// Runs the script with what env(1) takes before it.
  [[nodiscard]] ProgramRun run(std::vector<std::string> arguments) const {
    const fs::path script = test::sourceFolder() / "examples/ci/check_packs.sh";
    std::vector<std::string> line{"GALACTIC_BIN=" + programFolder().string(),
                                  "GOLDEN=" + golden_.string(), "bash", script.string()};
    line.insert(line.end(), arguments.begin(), arguments.end());
    return runProgram("/usr/bin/env", folder_.path(), std::move(line));
  }

  ScratchFolder folder_;
  fs::path golden_ = test::sourceFolder() / "examples/ci/golden";
};

TEST_F(CiJob, PassesOnTheSampleWorld) {
  const ProgramRun job = run({"out"});
  EXPECT_EQ(job.exit_code, 0) << job.out << job.err;
  EXPECT_EQ(job.err, "");
  for (const char* pack : {"apartment", "crate", "episodes", "objects", "porter", "world"}) {
    EXPECT_THAT(job.out, HasSubstr("/out/" + std::string(pack) + ".pack: ok\n"));
  }
  // Four of the six as parts of the world.
  EXPECT_THAT(fileContent(folder_.path() / "out/packs.xml"),
              HasSubstr("tests=\"6\" failures=\"0\" errors=\"0\""));
}

TEST_F(CiJob, FailsWithSevenWhereABakeDiffersAndStillChecksThePacks) {
  json report = json::parse(fileContent(golden_ / "crate.json"));
  const int count = report["baked"][0]["spheres"]["count"];
  report["baked"][0]["spheres"]["count"] = count + 1;
  static_cast<void>(folder_.write("golden/crate.json", report.dump()));
  golden_ = folder_.path() / "golden";
  const ProgramRun job = run({"out", "crate"});
  EXPECT_EQ(job.exit_code, 7);
  std::ostringstream line;
  line << "baked.crate.spheres.count: " << count + 1 << " | " << count << "\n";
  EXPECT_THAT(job.out, AllOf(HasSubstr(line.str()), HasSubstr("failed with exit code 7"),
                             HasSubstr("crate.pack: ok"), HasSubstr("== compare crate")));
}

TEST_F(CiJob, WritesGoldenReportsWhenAskedTo) {
  golden_ = folder_.path() / "golden";
  fs::create_directories(golden_);
  EXPECT_EQ(run({"--update", "out", "crate"}).exit_code, 0);
  EXPECT_EQ(json::parse(fileContent(golden_ / "crate.json"))["tool"], "galactic-bake");
  const ProgramRun again = run({"out", "crate"});
  EXPECT_EQ(again.exit_code, 0) << again.out << again.err;
}

TEST_F(CiJob, ExplainsAWrongCommandLine) {
  EXPECT_EQ(run({}).exit_code, 1);
  const ProgramRun unknown = run({"out", "attic"});
  EXPECT_EQ(unknown.exit_code, 1);
  EXPECT_THAT(unknown.err, HasSubstr("attic is none of apartment objects porter crate"));
}

TEST_F(CiJob, IsWhatTheWorkflowRuns) {
  const std::string workflow = fileContent(test::sourceFolder() / "examples/ci/packs.yml");
  EXPECT_THAT(workflow, AllOf(HasSubstr("examples/ci/check_packs.sh out"),
                              HasSubstr("scripts/setup.sh"), Not(HasSubstr("\t"))));
}

}  // namespace
}  // namespace galactic::test::ci_job_test
