// galactic-dynamics as a user meets it: stdout, stderr, exit codes and files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "galactic/error.h"
#include "support/journal.h"
#include "support/program_run.h"
#include "support/recipe_text.h"
#include "support/scratch_folder.h"
#include "support/source_folder.h"

namespace galactic::test::dynamics_cli_test {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

constexpr int kUsage = 1;
constexpr int kInvalid = 3;

class DynamicsCli : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<ScratchFolder>();
    const std::string recipe = quickRecipe("files = \"apartment.glb\"", "count = 6");
    ASSERT_TRUE(std::filesystem::exists(folder_->write("home.toml", recipe)));
    const std::string data = (sourceFolder() / "packs/sample").string();
    const ProgramRun baked =
        runProgram(GALACTIC_BAKE, folder_->path(), {"home.toml", "--data", data});
    ASSERT_EQ(baked.exit_code, 0) << baked.err;
    const ProgramRun ran = runProgram(GALACTIC_RUN, folder_->path(),
                                      {"home.pack", "--policy", "scripted", "--order", "partition",
                                       "--envs", "6", "--steps", "400", "--record", "home.rec"});
    ASSERT_EQ(ran.exit_code, 0) << ran.err;
  }
  static void TearDownTestSuite() { folder_.reset(); }

  [[nodiscard]] static ProgramRun run(std::vector<std::string> more) {
    std::vector<std::string> arguments{"home.toml", "home.pack", "--data",
                                       (sourceFolder() / "packs/sample").string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return runProgram(GALACTIC_DYNAMICS, folder_->path(), arguments);
  }
  /// The scripted policy in closed loop, told to end when the first episode is done.
  [[nodiscard]] static ProgramRun interrupted(const std::string& report) {
    const std::string script =
        "\"$@\" & tool=$!\n"
        "until grep -q number $report.partial 2> /dev/null; do :; done\n"
        "kill -TERM $tool; wait $tool";
    return runProgram("/usr/bin/env", folder_->path(),
                      {"report=" + report, "sh", "-c", script, "sh", GALACTIC_DYNAMICS, "home.toml",
                       "home.pack", "--data", (sourceFolder() / "packs/sample").string(),
                       "--policy", "scripted", "--report", report, "-j", "1"});
  }
  [[nodiscard]] static std::filesystem::path path(const std::string& name) {
    return folder_->path() / name;
  }
  [[nodiscard]] static json report(const std::string& name) {
    return json::parse(fileContent(path(name)));
  }

 private:
  static std::unique_ptr<ScratchFolder> folder_;
};
std::unique_ptr<ScratchFolder> DynamicsCli::folder_;

/// Changes what a journal says, and keeps its form.
void changeFirstRecord(const std::filesystem::path& file,
                       const std::function<void(std::string&)>& change) {
  const std::string text = fileContent(file);
  const std::size_t subject = text.find('\n') + 1;
  const std::string subject_line = text.substr(subject, text.find('\n', subject) - subject);
  auto journal = Journal::open(file, subject_line).value();
  std::vector<std::string> records(journal->records().begin(), journal->records().end());
  ASSERT_FALSE(records.empty());
  change(records.front());
  journal->remove();
  journal = Journal::open(file, subject_line).value();
  for (const std::string& record : records) ASSERT_TRUE(journal->add(record));
}

TEST_F(DynamicsCli, ReplaysARecording) {
  const ProgramRun done =
      run({"--recording", "home.rec", "--arm", "kinematic", "--report", "replay.json"});
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.out, HasSubstr("success in the dynamics"));
  EXPECT_THAT(done.out, HasSubstr("apart after 1 step"));
  EXPECT_THAT(done.err, HasSubstr("each of them weighs 0.5 kg"));
  const json found = report("replay.json");
  EXPECT_EQ(found["mode"], "replay");
  EXPECT_EQ(found["recording"], "home.rec");
  EXPECT_EQ(found["arm"], "kinematic");
  EXPECT_GT(found["episodes"], 2);
  EXPECT_EQ(found["each"].size(), found["episodes"]);
  EXPECT_FALSE(std::filesystem::exists(path("replay.json.partial")));
}

TEST_F(DynamicsCli, ClosesTheLoopAndSaysTheSameForAnyNumberOfThreads) {
  const auto closed = [](const std::string& name, const std::string& threads) {
    return run(
        {"--policy", "scripted", "--set", "episode-steps=400", "-j", threads, "--report", name});
  };
  const ProgramRun one = closed("one.json", "1");
  ASSERT_EQ(one.exit_code, 0) << one.err;
  const ProgramRun three = closed("three.json", "3");
  EXPECT_EQ(one.out, three.out);
  EXPECT_EQ(fileContent(path("one.json")), fileContent(path("three.json")));
  const json found = report("one.json");
  EXPECT_EQ(found["mode"], "closed loop");
  EXPECT_EQ(found["policy"], "scripted");
  EXPECT_EQ(found["episodes"], 6);
  EXPECT_GE(found["success"]["simulation"]["count"], 4);
  EXPECT_THAT(one.out, Not(HasSubstr("apart after")));
}

TEST_F(DynamicsCli, GoesOnWhereItWasInterrupted) {
  const std::vector<std::string> words{"--policy", "scripted", "--report", "again.json"};
  ASSERT_EQ(run(words).exit_code, 0);
  const std::string whole = fileContent(path("again.json"));
  const auto few = [&](const std::string& more) {
    std::vector<std::string> all = words;
    all.insert(all.end(), {"--arm", more});
    return run(all);
  };
  ASSERT_EQ(interrupted("again.json").exit_code, kExitInterrupted);
  // One number is changed to see that what is done is not computed again.
  changeFirstRecord(path("again.json.partial"), [](std::string& record) {
    const std::string disturbed = "\"disturbed\":";
    record.insert(record.find(disturbed) + disturbed.size(), "70");
  });
  ASSERT_EQ(run(words).exit_code, 0);
  const json before = json::parse(whole);
  const json after = report("again.json");
  EXPECT_GE(after["disturbed_objects"], 700 + before["disturbed_objects"].get<int>() % 10);
  EXPECT_EQ(after["success"], before["success"]);
  // Another arm has nothing to do with it.
  EXPECT_EQ(few("kinematic").exit_code, 0);
  EXPECT_LT(report("again.json")["disturbed_objects"], 70);
}

TEST_F(DynamicsCli, SaysHowToGoOnWhenItIsInterrupted) {
  const ProgramRun stopped = interrupted("stopped.json");
  EXPECT_EQ(stopped.exit_code, kExitInterrupted) << stopped.err;
  EXPECT_THAT(stopped.err, HasSubstr("galactic-dynamics: interrupted after "));
  EXPECT_THAT(stopped.err, HasSubstr(" of 6 episodes; start it again to go on from there\n"));
  EXPECT_TRUE(stopped.out.empty()) << stopped.out;
  EXPECT_TRUE(std::filesystem::exists(path("stopped.json.partial")));
  EXPECT_FALSE(std::filesystem::exists(path("stopped.json")));
  ASSERT_EQ(run({"--policy", "scripted", "--report", "stopped.json"}).exit_code, 0);
  ASSERT_EQ(run({"--policy", "scripted", "--report", "through.json"}).exit_code, 0);
  EXPECT_EQ(fileContent(path("stopped.json")), fileContent(path("through.json")));
}

TEST_F(DynamicsCli, ShowsTheWorstMoments) {
  const ProgramRun done =
      run({"--recording", "home.rec", "--view", "both.html", "--pictures", "both.png", "--quiet"});
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_TRUE(done.out.empty());
  EXPECT_TRUE(done.err.empty()) << done.err;
  EXPECT_THAT(fileContent(path("both.html")), HasSubstr("<title>both</title>"));
  EXPECT_EQ(fileContent(path("both.png")).substr(1, 3), "PNG");
}

TEST_F(DynamicsCli, RefusesWhatItCannotDo) {
  struct Refusal {
    std::vector<std::string> words;
    int code;
    const char* part;
  };
  const std::vector<Refusal> refusals{
      {{}, kUsage, "either --recording, to replay it, or --policy"},
      {{"--recording", "home.rec", "--policy", "scripted"}, kUsage, "either --recording"},
      {{"--policy", "random"}, kUsage, "unknown policy random, expected scripted or FILE.pack"},
      {{"--policy", "scripted", "--deterministic"}, kUsage, "applies to learned policies only"},
      {{"--recording", "home.rec", "--seed", "2"}, kUsage, "--seed applies to a closed loop only"},
      {{"--policy", "scripted", "--set", "nonsense"}, kUsage, "expected NAME=VALUE"},
      {{"--policy", "scripted", "--arm", "none"}, kUsage, "--arm"},
      {{"--policy", "scripted", "--episodes", "-1"}, kUsage, "--episodes"},
      {{"--policy", "scripted", "--report", ""}, kUsage, "--report has an empty value"},
      {{"--policy", "scripted", "--set", "gravity=1"}, kInvalid, "gravity=1 is no option"},
      {{"--policy", "home.pack"}, kInvalid, "home.pack"},
      {{"--recording", "home.rec", "--report", "home.rec"}, kInvalid, "is also an input"},
      {{"--policy", "scripted", "--report", "home/episodes.pack"}, kInvalid, "is also an input"},
      {{"--recording", "home.pack"}, kInvalid, "home.pack"},
      {{"--recording", "none.rec"}, 2, "none.rec"},
  };
  for (const Refusal& refusal : refusals) {
    const ProgramRun done = run(refusal.words);
    EXPECT_EQ(done.exit_code, refusal.code) << refusal.part << "\n" << done.err;
    EXPECT_THAT(done.err, HasSubstr(refusal.part));
    EXPECT_THAT(done.err, HasSubstr("galactic-dynamics: "));
  }
}

TEST_F(DynamicsCli, ReplacesNothingThatIsReadOrWritten) {
  // Its own sources, so that nothing is lost if one is replaced.
  std::filesystem::copy(sourceFolder() / "packs/sample", path("sources"),
                        std::filesystem::copy_options::recursive);
  std::filesystem::create_symlink(path("sources/apartment.glb"), path("linked.html"));
  std::map<std::filesystem::path, std::string> before;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(path(""))) {
    // But what the programs print.
    const bool counts = entry.is_regular_file() && entry.path().extension() != ".txt";
    if (counts) before.emplace(entry.path(), fileContent(entry.path()));
  }
  const std::string input = "is also an input; write to another file\n";
  const std::string twice = "would be written twice: by ";
  std::vector<std::pair<std::vector<std::string>, std::string>> attempts{
      {{"--view", "home.toml"}, input},
      {{"--pictures", "home/episodes.pack"}, input},
      {{"--view", "linked.html"}, input},
      {{"--view", "a", "--pictures", "./a"}, twice + "--view and by --pictures; give each its"},
      {{"--report", "a", "--view", "a.partial"}, twice + "--report and by --view; give each its"},
  };
  for (const char* source :
       {"apartment.glb", "objects/mug.glb", "robot/porter.urdf", "robot/robot.toml"}) {
    attempts.push_back({{"--pictures", path("sources") / source}, input});
  }
  for (const auto& [words, message] : attempts) {
    std::vector<std::string> arguments{"home.toml", "home.pack", "--data", "sources",
                                       "--policy",  "scripted",  "-q"};
    arguments.insert(arguments.end(), words.begin(), words.end());
    const ProgramRun done = runProgram(GALACTIC_DYNAMICS, path("").parent_path(), arguments);
    EXPECT_EQ(done.exit_code, kInvalid) << words.back();
    EXPECT_THAT(done.err, HasSubstr(message)) << words.back();
  }
  for (const auto& [file, content] : before) {
    EXPECT_TRUE(fileContent(file) == content) << file;
  }
  EXPECT_FALSE(std::filesystem::exists(path("a")));
}

TEST_F(DynamicsCli, KeepsItsExitCodeWhereNobodyHearsItsErrors) {
  for (const char* unheard : {"2>&-", "2>/dev/full"}) {
    const ProgramRun done =
        runRedirected(GALACTIC_DYNAMICS, path("").parent_path(), {"--nonsense"}, unheard);
    EXPECT_EQ(done.exit_code, kUsage) << unheard;
  }
}

TEST_F(DynamicsCli, TriesItsOutputsBeforeTheWork) {
  for (const char* option : {"--view", "--pictures"}) {
    const ProgramRun done =
        run({"--policy", "scripted", "--report", "tried.json", option, "no/such/folder/file"});
    EXPECT_EQ(done.exit_code, 2) << done.err;
    EXPECT_TRUE(done.out.empty()) << done.out;
    EXPECT_FALSE(std::filesystem::exists(path("tried.json.partial"))) << option;
  }
  const ProgramRun report = run({"--policy", "scripted", "--report", "no/such/folder/file"});
  EXPECT_EQ(report.exit_code, 2) << report.err;
  EXPECT_TRUE(report.out.empty()) << report.out;
}

TEST_F(DynamicsCli, GroupsWarningsAndReportsAllOfThem) {
  const ProgramRun done =
      run({"--policy", "scripted", "--episodes", "1", "--report", "warnings.json"});
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.err, HasSubstr("has no <inertial>"));
  EXPECT_THAT(done.err, HasSubstr("more of this kind; --report lists them)"));
  const auto lines = std::count(done.err.begin(), done.err.end(), '\n');
  EXPECT_LT(lines, 6) << done.err;
  EXPECT_GT(report("warnings.json").at("warnings").size(), 12U);
}

TEST_F(DynamicsCli, NamesTheOptionThatTellsWhereFilesAre) {
  const ProgramRun done = runProgram(GALACTIC_DYNAMICS, path("").parent_path(),
                                     {"home.toml", "home.pack", "--policy", "scripted"});
  EXPECT_EQ(done.exit_code, 2);
  EXPECT_THAT(done.err, HasSubstr("or tell with --data where the files are"));
}

TEST_F(DynamicsCli, PrintsHelpAndVersion) {
  const ProgramRun help = run({"--help"});
  EXPECT_EQ(help.exit_code, 0);
  for (const char* part : {"--recording", "--policy", "--view", "--pictures", "--base", "Exit"}) {
    EXPECT_THAT(help.out, HasSubstr(part));
  }
  EXPECT_THAT(run({"--version"}).out, HasSubstr("galactic-dynamics "));
}

}  // namespace
}  // namespace galactic::test::dynamics_cli_test
