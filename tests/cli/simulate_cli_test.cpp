// Simulations with galactic-run as a user meets them: table, report, recordings, exit codes.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "cli/simulation_folder.h"
#include "galactic/error.h"
#include "run/recording.h"
#include "support/build_paths.h"
#include "support/homes/small_home.h"
#include "support/program_run.h"

namespace galactic::simulate_cli_test {
namespace {

using nlohmann::json;
using test::ProgramRun;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

using SimulateCli = test::SimulationFolder;

TEST_F(SimulateCli, EndsWithATable) {
  const ProgramRun result = run({"--envs", "20", "--steps", "50", "--seed", "3", "-j", "2"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out,
              AllOf(StartsWith("20 envs, 50 steps each, 2 threads, policy random, seed 3\n"),
                    HasSubstr("\n  stepping "), HasSubstr(" steps/s"), HasSubstr("\n  whole loop "),
                    HasSubstr("\n  start-up "), HasSubstr(" bytes per env, "),
                    HasSubstr("\n    collide "), HasSubstr("% refused, "), HasSubstr(" grasps, ")));
  EXPECT_THAT(result.out, AllOf(HasSubstr(" ended: "), HasSubstr("means of the episodes"),
                                HasSubstr("\n  skipped       1 of 4 episodes: 2\n")));
  // No live line where there is no terminal.
  EXPECT_THAT(result.err, IsEmpty());
}

TEST_F(SimulateCli, TellsInHowManyEpisodesTheTargetWasPicked) {
  const std::vector<std::string> solved{"--envs",   "3",        "--steps", "150",
                                        "--policy", "scripted", "--order", "partition"};
  EXPECT_THAT(run(solved).out, HasSubstr("\n  episodes      3 of 3 ended: 3 successes, 0 failures, "
                                         "0 out of time; 3 picked\n"));
  EXPECT_EQ(reportOf(solved)["episodes"]["picked"], 3);
  EXPECT_THAT(
      run({"--envs", "3", "--steps", "20", "--policy", "zero", "--episode-steps", "20"}).out,
      HasSubstr("\n  episodes      3 ended: 0 successes, 0 failures, 3 out of time; "
                "0 picked\n"));
  // Where nothing is asked of the target, nobody wants to know.
  EXPECT_THAT(run({"--envs", "3", "--steps", "20", "--task", "none", "--episode-steps", "20"}).out,
              HasSubstr("\n  episodes      3 ended: 0 successes, 0 failures, 3 out of time\n"));
}

TEST_F(SimulateCli, GivesNoMeansOfEpisodesWhereNoneEnded) {
  const ProgramRun result = run({"--envs", "2", "--steps", "1"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, AllOf(HasSubstr("\n  episodes      0 ended: "), HasSubstr("\n  skipped "),
                                Not(HasSubstr("\n  return "))));
}

TEST_F(SimulateCli, TakesThePacksThemselvesToo) {
  const ProgramRun result =
      runBare({"episodes.pack", "objects.pack", "robots/helper.pack", "scenes/kitchen.pack",
               "--trusted", "--envs", "1", "--steps", "1"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, StartsWith("1 env, 1 step each, 1 thread"));
}

TEST_F(SimulateCli, StillDescribesAWorldWhenNoSimulationIsAskedFor) {
  const ProgramRun result = run({});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, StartsWith("world.pack: world of 4 packs"));
}

TEST_F(SimulateCli, ReportsAsJson) {
  const json report = reportOf({"--envs", "12", "--steps", "60", "--episode-steps", "20", "--order",
                                "linear", "--task", "pick", "--no-distractors"});
  EXPECT_EQ(report["env_steps"], 720);
  EXPECT_EQ(report["steps"], 60);
  EXPECT_EQ(report["interrupted"], false);
  EXPECT_EQ(report["policy"], "random");
  EXPECT_EQ(report["packs"], json::array({"world.pack"}));
  EXPECT_EQ(report["options"]["task"], "pick");
  EXPECT_EQ(report["options"]["order"], "linear");
  EXPECT_EQ(report["options"]["envs"], 12);
  EXPECT_EQ(report["options"]["no-distractors"], true);
  EXPECT_EQ(report["options"]["safe-drop"], false);
  EXPECT_EQ(report["phase_ns_per_step"].size(), 10U);
  EXPECT_GT(report["steps_per_second"].get<double>(),
            report["loop_steps_per_second"].get<double>());
  EXPECT_EQ(report["episodes"]["skipped"], json::array({2}));
  EXPECT_EQ(report["episodes"]["in_world"], 4);
  const json& episodes = report["episodes"];
  EXPECT_GE(episodes["ended"], 36);
  EXPECT_EQ(episodes["ended"].get<int>(), episodes["successes"].get<int>() +
                                              episodes["failures"].get<int>() +
                                              episodes["out_of_time"].get<int>());
  // Who has the target in the hand has solved this task.
  EXPECT_EQ(episodes["picked"], episodes["successes"]);
  EXPECT_TRUE(episodes["mean_return"].is_number());
  EXPECT_LE(episodes["mean_steps"].get<double>(), 20);
  EXPECT_FALSE(report.contains("first_difference"));
}

TEST_F(SimulateCli, TakesTheTaskOfTheWorldWhichTheCommandLineOverrides) {
  test::WorldPackFields list = test::writePacks(folder_, test::smallHomeWorld());
  list.task = test::TaskTexts{{"task", "pick"}, {"episode-steps", "20"}, {"safe-drop", "true"}};
  ASSERT_FALSE(folder_.write("world.pack", test::textOf(buildPack(list))).empty());
  const std::vector<std::string> plain{"--envs", "4", "--steps", "60", "--threads", "1"};
  const auto with = [&plain](std::vector<std::string> more) {
    more.insert(more.begin(), plain.begin(), plain.end());
    return more;
  };
  const json report = reportOf(plain);
  EXPECT_EQ(report["options"]["task"], "pick");
  EXPECT_EQ(report["options"]["episode-steps"], 20);
  EXPECT_EQ(report["options"]["safe-drop"], true);
  EXPECT_EQ(report["from_world"], json::array({"task", "episode-steps", "safe-drop"}));
  EXPECT_GE(report["episodes"]["ended"], 12);
  EXPECT_THAT(run(plain).out,
              HasSubstr("\n  world's task  task pick, episode-steps 20, safe-drop true\n"));

  const json typed = reportOf(with({"--episode-steps", "0", "--safe-drop=false"}));
  EXPECT_EQ(typed["options"]["task"], "pick");
  EXPECT_EQ(typed["options"]["episode-steps"], 0);
  EXPECT_EQ(typed["options"]["safe-drop"], false);
  EXPECT_EQ(typed["from_world"], json::array({"task"}));
  EXPECT_LT(typed["episodes"]["ended"], report["episodes"]["ended"]);
  EXPECT_THAT(run(with({"--episode-steps", "30", "--task", "none"})).out,
              HasSubstr("\n  world's task  safe-drop true; not task pick, episode-steps 20\n"));
  // Its packs one by one say nothing of a task.
  const ProgramRun loose = runBare({"episodes.pack", "objects.pack", "robots/helper.pack",
                                    "scenes/kitchen.pack", "--envs", "1", "--steps", "1"});
  EXPECT_EQ(loose.exit_code, 0) << loose.err;
  EXPECT_THAT(loose.out, Not(HasSubstr("world's task")));
  // The same steps as with the options typed.
  ASSERT_EQ(run(with({"--record", "a.rec"})).exit_code, 0);
  writeWorld(test::smallHomeWorld());
  ASSERT_EQ(
      run(with({"--task", "pick", "--episode-steps", "20", "--safe-drop", "--record", "b.rec"}))
          .exit_code,
      0);
  EXPECT_TRUE(content("a.rec") == content("b.rec"));
  // A recording has the options that it was made with, whatever the world says.
  EXPECT_EQ(run({"--policy", "replay:a.rec"}).exit_code, 0);
  EXPECT_THAT(runBare({"world.pack"}).out, Not(HasSubstr("task:")));
}

TEST_F(SimulateCli, RefusesWhatHasNoEffectUnlessTheWorldGivesItOne) {
  const std::vector<std::string> narrow{"--envs", "1", "--steps", "1", "--laser-fov", "90"};
  const ProgramRun refused = run(narrow);
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_EQ(refused.err,
            "galactic-run: command line: --laser-fov applies to a laser scan only; add "
            "--laser-beams N; see --help\n");
  EXPECT_THAT(refused.out, IsEmpty());
  const ProgramRun unpaid = run({"--envs", "1", "--steps", "1", "--drop-penalty", "1"});
  EXPECT_EQ(unpaid.exit_code, 1);
  EXPECT_EQ(unpaid.err,
            "galactic-run: command line: --drop-penalty applies to what safe drop overlooks only; "
            "add --safe-drop; see --help\n");
  const ProgramRun paid =
      run({"--envs", "1", "--steps", "1", "--drop-penalty", "1", "--safe-drop"});
  EXPECT_EQ(paid.exit_code, 0) << paid.err;
  test::WorldPackFields list = test::writePacks(folder_, test::smallHomeWorld());
  list.task = test::TaskTexts{{"laser-beams", "8"}};
  ASSERT_FALSE(folder_.write("world.pack", test::textOf(buildPack(list))).empty());
  const ProgramRun fine = run(narrow);
  EXPECT_EQ(fine.exit_code, 0) << fine.err;
}

TEST_F(SimulateCli, RefusesAWorldWhoseTaskIsNone) {
  test::WorldPackFields list = test::writePacks(folder_, test::smallHomeWorld());
  list.task = test::TaskTexts{{"episode-steps", "many"}};
  ASSERT_FALSE(folder_.write("world.pack", test::textOf(buildPack(list))).empty());
  for (const char* trust : {"--body-transforms", "--trusted"}) {
    const ProgramRun refused = run({"--envs", "1", "--steps", "1", trust});
    EXPECT_EQ(refused.exit_code, 3);
    EXPECT_THAT(refused.err,
                HasSubstr("world.pack: world.task[0].value: is \"many\", expected 0 to"));
  }
}

TEST_F(SimulateCli, EscapesNamesInTheReport) {
  const std::string name = "a \"strange\"\n\\name\xff.pack";
  std::filesystem::rename(folder_.path() / "world.pack", folder_.path() / name);
  const ProgramRun result =
      runBare({name, "--envs", "1", "--steps", "1", "--report", "report.json"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const json report = json::parse(content("report.json"), nullptr, false);
  ASSERT_TRUE(report.is_object()) << content("report.json");
  EXPECT_EQ(report["packs"][0], "a \"strange\"\n\\name?.pack");
  EXPECT_TRUE(report["episodes"]["mean_return"].is_null()) << "no episode has ended";
}

TEST_F(SimulateCli, HasPoliciesThatDiffer) {
  const auto refusedWith = [&](const char* policy) {
    return reportOf(
               {"--envs", "16", "--steps", "200", "--policy", policy, "--task", "none"})["refused"]
        .get<int>();
  };
  EXPECT_EQ(refusedWith("zero"), 0);
  EXPECT_GT(refusedWith("forward"), refusedWith("random"));
}

TEST_F(SimulateCli, IsTheSameForTheSameSeedOnly) {
  const std::vector<std::string> arguments{"--envs", "20", "--steps", "100", "--threads"};
  const auto rewardOf = [&](const char* threads, const char* seed) {
    std::vector<std::string> all = arguments;
    all.insert(all.end(), {threads, "--seed", seed});
    return reportOf(all)["reward"].get<double>();
  };
  EXPECT_EQ(rewardOf("1", "5"), rewardOf("2", "5"));
  EXPECT_NE(rewardOf("1", "5"), rewardOf("1", "6"));
}

TEST_F(SimulateCli, RefusesNoiseThatIsNoShare) {
  for (const char* option : {"--motion-noise", "--motion-bias", "--localization-noise"}) {
    for (const char* value :
         {"-0.1", "1.1", "nan", "much", "0.5-0.2", "0.1-1.1", "0-nan", "0.1..0.2"}) {
      const ProgramRun result = run({"--steps", "1", option, value});
      EXPECT_EQ(result.exit_code, 1) << option << " " << value;
      EXPECT_THAT(result.err, HasSubstr(option));
    }
  }
}

TEST_F(SimulateCli, EndsWithACodeForEachKindOfMistake) {
  const std::vector<std::pair<std::vector<std::string>, int>> mistakes{
      {{"--policy", "dance"}, 1},
      {{"--envs", "0"}, 1},
      {{"--steps", "5", "--bench"}, 1},
      {{"--policy", "replay:missing.rec"}, 2},
      {{"--envs", "1", "--steps", "1", "--record", "missing/run.rec"}, 2},
      {{"--envs", "1", "--steps", "1", "--report", "missing/report.json"}, 2},
      {{"--policy", "replay:world.pack"}, 3},
      {{"--steps", "1", "--view-envs", "2"}, 1},
      {{"--steps", "1", "--view", "run.html", "--view-envs", "0"}, 1},
      {{"--steps", "1000000", "--envs", "2", "--view", "run.html"}, 1},
      {{"--envs", "1", "--steps", "1", "--view", "missing/run.html"}, 2},
      {{"--envs", "1", "--steps", "1", "--view", "world.pack"}, 3},
      {{"--envs", "1", "--steps", "1", "--view", "run.png"}, 5},
      {{"--steps", "1000001", "--envs", "2", "--animation", "run.glb"}, 1},
      {{"--envs", "1", "--steps", "1", "--animation", "missing/run.glb"}, 2},
      {{"--envs", "1", "--steps", "1", "--animation", "objects.pack"}, 3},
      {{"--envs", "1", "--steps", "1", "--animation", "run.fbx"}, 5},
  };
  for (const auto& [arguments, code] : mistakes) {
    SCOPED_TRACE(testing::PrintToString(arguments));
    const ProgramRun result = run(arguments);
    EXPECT_EQ(result.exit_code, code);
    EXPECT_THAT(result.err, StartsWith("galactic-run: "));
  }
  const ProgramRun alone = runBare({"scenes/kitchen.pack", "--steps", "1"});
  EXPECT_EQ(alone.exit_code, 3);
  std::filesystem::remove(folder_.path() / "objects.pack");
  EXPECT_EQ(run({"--steps", "1"}).exit_code, 3);
}

TEST_F(SimulateCli, ReplacesNothingThatItReads) {
  record();
  std::filesystem::create_symlink("objects.pack", folder_.path() / "link.pack");
  const std::string kitchen = "scenes/kitchen.pack";
  // What is written, the option that asks for it, and the file that would be lost.
  const std::vector<std::tuple<std::string, std::string, std::string>> attempts{
      {"world.pack", "--record", "world.pack"},
      {"./world.pack", "--report", "world.pack"},
      {(folder_.path() / "world.pack").string(), "--view", "world.pack"},
      {kitchen, "--record", kitchen},
      {"scenes/../scenes/kitchen.pack", "--report", kitchen},
      {"episodes.pack", "--animation", "episodes.pack"},
      {"link.pack", "--record", "objects.pack"},
      {"link.pack", "--report", "objects.pack"},
      {"run.rec", "--record", "run.rec"},
      {"./run.rec", "--report", "run.rec"},
  };
  for (const auto& [output, option, file] : attempts) {
    SCOPED_TRACE(option + " " + output);
    const std::string before = content(file);
    const ProgramRun result = run({"--policy", "replay:run.rec", "--steps", "3", option, output});
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_EQ(result.err,
              "galactic-run: " + output + ": is also an input; write to another file\n");
    EXPECT_THAT(result.out, IsEmpty());
    EXPECT_TRUE(content(file) == before);
  }
  // Packs that are named one by one.
  const std::string before = content(kitchen);
  EXPECT_EQ(runBare({"episodes.pack", "objects.pack", "robots/helper.pack", kitchen, "--envs", "1",
                     "--steps", "1", "--record", kitchen})
                .exit_code,
            3);
  EXPECT_TRUE(content(kitchen) == before);
}

TEST_F(SimulateCli, WritesNoFileTwice) {
  static_cast<void>(folder_.write("old", "kept"));
  std::filesystem::create_symlink("old", folder_.path() / "link");
  const std::vector<std::pair<std::string, std::string>> pairs{
      {"a", "a"}, {"a", "./a"}, {"a", (folder_.path() / "a").string()}, {"old", "link"}};
  for (const auto& [record, report] : pairs) {
    const ProgramRun result =
        run({"--envs", "1", "--steps", "1", "--record", record, "--report", report});
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_EQ(result.err, "galactic-run: " + report +
                              ": would be written twice: by --record and by --report; give each "
                              "its own name\n");
  }
  EXPECT_EQ(content("old"), "kept");
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "a"));
}

TEST_F(SimulateCli, TriesItsFilesBeforeItSteps) {
  const std::vector<std::pair<std::string, std::string>> outputs{
      {"--record", "missing/run.rec"},
      {"--report", "missing/run.json"},
      {"--view", "missing/run.html"},
      {"--animation", "missing/run.glb"}};
  for (const auto& [option, file] : outputs) {
    // Of a run that began, the table would be there.
    const ProgramRun result = run({"--envs", "1", "--steps", "1", option, file});
    EXPECT_EQ(result.exit_code, 2) << option;
    EXPECT_THAT(result.err, StartsWith("galactic-run: " + file + ": cannot write the file"))
        << option;
    EXPECT_THAT(result.out, IsEmpty()) << option;
  }
}

TEST_F(SimulateCli, WritesPagesUnderNamesOfPages) {
  for (const char* name : {"page.html", "page.htm", "page.HTML"}) {
    EXPECT_EQ(run({"--envs", "1", "--steps", "1", "--view", name}).exit_code, 0) << name;
    EXPECT_THAT(content(name), StartsWith("<!doctype html>")) << name;
  }
  for (const char* name : {"page.png", "page", "html"}) {
    const ProgramRun result = run({"--envs", "1", "--steps", "1", "--view", name});
    EXPECT_EQ(result.exit_code, 5) << name;
    EXPECT_EQ(result.err, "galactic-run: " + std::string(name) +
                              ": pages are HTML files; end the name with .html\n");
    EXPECT_FALSE(std::filesystem::exists(folder_.path() / name));
  }
}

TEST_F(SimulateCli, WritesItsFilesNeitherToStandardOutputNorUnderADash) {
  const auto expectRefused = [this](const char* option, const std::string& name) {
    const ProgramRun result = run({"--envs", "1", "--steps", "1", option, name});
    EXPECT_EQ(result.exit_code, 2) << option;
    EXPECT_THAT(result.err, AllOf(StartsWith("galactic-run: " + name + ": "), HasSubstr("give a")))
        << option;
    EXPECT_THAT(result.out, IsEmpty());
  };
  for (const char* option : {"--record", "--report", "--view", "--animation"}) {
    expectRefused(option, "-");
  }
  for (const char* option : {"--record", "--report"}) expectRefused(option, "/dev/stdout");
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "-"));
  EXPECT_EQ(run({"--envs", "1", "--steps", "1", "--report", "./-"}).exit_code, 0);
  EXPECT_THAT(content("-"), StartsWith("{"));
}

TEST_F(SimulateCli, WritesTheSamePageForARunAndItsReplay) {
  record();
  const auto page = [this](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"--policy", "replay:run.rec", "--view", "page.html"});
    const ProgramRun result = run(std::move(arguments));
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return content("page.html");
  };
  const std::string one = page({"--threads", "1"});
  EXPECT_THAT(one, AllOf(StartsWith("<!doctype html>"), HasSubstr("<title>page</title>")));
  EXPECT_EQ(page({"--threads", "3"}), one);
  EXPECT_NE(page({"--view-envs", "1"}), one);
  EXPECT_LT(page({"--view-envs", "1"}).size(), one.size());
}

TEST_F(SimulateCli, KeepsTheRecordingWhereAnotherFileCannotBeWritten) {
  const std::filesystem::path pages = folder_.path() / "pages";
  std::filesystem::create_directory(pages);
  const test::StartedProgram started(
      test::builtProgram("galactic-run"), folder_.path(),
      {"world.pack", "--envs", "1", "--steps", "1000000", "--threads", "1", "--record", "run.rec",
       "--view", "pages/run.html", "--view-envs", "1"});
  waitForRecording();
  std::filesystem::remove(pages);
  started.signal(SIGINT);
  const ProgramRun result = started.wait();
  EXPECT_EQ(result.exit_code, 2) << result.err;
  EXPECT_THAT(result.err, HasSubstr("\ngalactic-run: pages/run.html: cannot write the file"));
  EXPECT_TRUE(RecordingReader::open(folder_.path() / "run.rec"));
}

TEST_F(SimulateCli, KeepsTheRestOfARunWhoseRecordingFillsTheDisk) {
  // A limit of 256 blocks of 512 bytes for each file, which only the recording reaches.
  const ProgramRun result = test::runProgram(
      "/bin/sh", folder_.path(),
      {"-c", "trap '' XFSZ; ulimit -f 256; exec \"$0\" \"$@\"", test::builtProgram("galactic-run"),
       "world.pack", "--envs", "8", "--steps", "100000", "--threads", "1", "--record", "run.rec",
       "--report", "report.json", "--animation", "run.glb"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.err,
            "galactic-run: run.rec: cannot write the file: File too large; an existing "
            "file is left as it was\n");
  EXPECT_THAT(result.out, AllOf(StartsWith("8 envs, "), HasSubstr("(stopped; 100000 steps"),
                                HasSubstr("\n  episodes ")));
  const json report = json::parse(content("report.json"), nullptr, false);
  ASSERT_TRUE(report.is_object());
  EXPECT_EQ(report["interrupted"], true);
  EXPECT_GT(report["steps"].get<int>(), 0);
  EXPECT_THAT(result.out, StartsWith("8 envs, " + report["steps"].dump() + " steps each"));
  EXPECT_THAT(content("run.glb"), StartsWith("glTF"));
  EXPECT_THAT(files(), Not(testing::Contains(StartsWith("run.rec"))));
}

TEST_F(SimulateCli, RemovesWhatAKilledRunLeftOfTheSameFile) {
  const test::StartedProgram started(test::builtProgram("galactic-run"), folder_.path(),
                                     {"world.pack", "--envs", "1", "--steps", "100000000000",
                                      "--threads", "1", "--record", "run.rec"});
  waitForRecording();
  started.signal(SIGKILL);
  ASSERT_EQ(started.wait().exit_code, -1);
  EXPECT_THAT(files(), testing::Contains(StartsWith("run.rec.part-")));
  EXPECT_EQ(run({"--envs", "1", "--steps", "1", "--record", "another.rec"}).exit_code, 0);
  EXPECT_THAT(files(), testing::Contains(StartsWith("run.rec.part-")));
  EXPECT_EQ(run({"--envs", "1", "--steps", "1", "--record", "run.rec"}).exit_code, 0);
  EXPECT_THAT(files(), Not(testing::Contains(HasSubstr(".part-"))));
}

TEST_F(SimulateCli, WritesItsFilesWhenItsTerminalCloses) {
  const int terminal = ::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
  ASSERT_TRUE(terminal >= 0 && ::grantpt(terminal) == 0 && ::unlockpt(terminal) == 0);
  const std::string name = ::ptsname(terminal);
  const std::string program = test::builtProgram("galactic-run");
  const pid_t child = ::fork();
  if (child == 0) {
    // Also where the tests were started with nohup.
    std::signal(SIGHUP, SIG_DFL);
    // The first one that a leader of a session opens is its terminal.
    ::setsid();
    const int end = ::open(name.c_str(), O_RDWR);
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) ::dup2(end, stream);
    if (::chdir(folder_.path().c_str()) != 0) ::_exit(1);
    ::execl(program.c_str(), program.c_str(), "world.pack", "--envs", "1", "--threads", "1",
            "--steps", "100000000000", "--record", "run.rec", "--report", "run.json", nullptr);
    ::_exit(1);
  }
  waitForRecording();
  ::close(terminal);
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), kExitInterrupted);
  EXPECT_TRUE(RecordingReader::open(folder_.path() / "run.rec"));
  EXPECT_EQ(json::parse(content("run.json"), nullptr, false).value("interrupted", false), true);
}

TEST_F(SimulateCli, NamesThePackThatIsCutShortWhileItRuns) {
  const test::StartedProgram started(test::builtProgram("galactic-run"), folder_.path(),
                                     {"world.pack", "--envs", "8", "--steps", "100000000000",
                                      "--threads", "2", "--record", "run.rec"});
  waitForRecording();
  std::filesystem::resize_file(folder_.path() / "scenes/kitchen.pack", 0);
  const ProgramRun result = started.wait();
  EXPECT_EQ(result.exit_code, 2) << result.err;
  EXPECT_THAT(result.err,
              testing::MatchesRegex(
                  "galactic-run: [^\n]*/scenes/kitchen.pack: was cut short while it was in use, "
                  "[^\n]*\n"));
}

TEST_F(SimulateCli, EndsCleanlyWhenItIsInterrupted) {
  // timeout sends what Ctrl-C does; the run itself would take days.
  const ProgramRun result =
      test::runProgram("/usr/bin/timeout", folder_.path(),
                       {"--foreground", "--preserve-status", "--signal=INT", "2",
                        test::builtProgram("galactic-run"), "world.pack", "--envs", "8", "--steps",
                        "100000000000", "--threads", "2", "--record", "run.rec"});
  EXPECT_EQ(result.exit_code, kExitInterrupted) << result.err;
  EXPECT_THAT(result.out, AllOf(StartsWith("8 envs, "), HasSubstr("(stopped; 100000000000 steps"),
                                HasSubstr("\n  stepping ")));
  const Result<RecordingReader> reader = RecordingReader::open(folder_.path() / "run.rec");
  ASSERT_TRUE(reader) << reader.error().message;
  EXPECT_GT(reader->steps(), 0U);
  EXPECT_THAT(result.out, StartsWith("8 envs, " + std::to_string(reader->steps()) + " steps each"));
}

}  // namespace
}  // namespace galactic::simulate_cli_test
