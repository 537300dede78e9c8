// galactic-dynamics as a user meets it: stdout, stderr, exit codes and files.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "galactic/error.h"
#include "support/build_paths.h"
#include "support/file_content.h"
#include "support/files/journal.h"
#include "support/mesh_files.h"
#include "support/program_run.h"
#include "support/recipe_text.h"
#include "support/scratch_folder.h"

namespace galactic::test::dynamics_cli_test {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::UnorderedElementsAre;

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
        runProgram(builtProgram("galactic-bake"), folder_->path(), {"home.toml", "--data", data});
    ASSERT_EQ(baked.exit_code, 0) << baked.err;
    const ProgramRun ran = runProgram(builtProgram("galactic-run"), folder_->path(),
                                      {"home.pack", "--policy", "scripted", "--order", "partition",
                                       "--envs", "6", "--steps", "400", "--record", "home.rec"});
    ASSERT_EQ(ran.exit_code, 0) << ran.err;
  }
  static void TearDownTestSuite() { folder_.reset(); }

  /// What the home was baked from.
  [[nodiscard]] static std::string sample() { return (sourceFolder() / "packs/sample").string(); }
  /// A copy of that below the folder, for tests that change it.
  [[nodiscard]] static std::string copyOfSample(const std::string& name) {
    std::filesystem::copy(sample(), path(name), std::filesystem::copy_options::recursive);
    return name;
  }
  [[nodiscard]] static ProgramRun run(
      std::vector<std::string> more, const std::string& data = sample(),
      const std::string& program = builtProgram("galactic-dynamics")) {
    std::vector<std::string> arguments{"home.toml", "home.pack", "--data", data};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return runProgram(program, folder_->path(), arguments);
  }
  /// The scripted policy in closed loop, told to end when the first episode is done.
  [[nodiscard]] static ProgramRun interrupted(const std::string& report,
                                              const std::string& data = sample(),
                                              const std::string& signal = "TERM") {
    const std::string script =
        "\"$@\" & tool=$!\n"
        "until grep -q number $report.partial 2> /dev/null; do :; done\n"
        "kill -" +
        signal + " $tool; wait $tool";
    return runProgram("/usr/bin/env", folder_->path(),
                      {"report=" + report, "sh", "-c", script, "sh",
                       builtProgram("galactic-dynamics"), "home.toml", "home.pack", "--data", data,
                       "--policy", "scripted", "--report", report, "-j", "1"});
  }
  [[nodiscard]] static std::filesystem::path path(const std::string& name) {
    return folder_->path() / name;
  }
  static void write(const std::string& name, const std::string& text) {
    ASSERT_TRUE(std::filesystem::exists(folder_->write(name, text)));
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

/// So many objects are disturbed in no run.
constexpr int kMark = 700;

/// Changes one number, to see that what is done is not computed again.
void markRecord(std::string& record) {
  const std::string disturbed = "\"disturbed\":";
  record.insert(record.find(disturbed) + disturbed.size(), "70");
}

void append(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file, std::ios::app | std::ios::binary) << text;
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
  EXPECT_EQ(found["options"],
            json({{"arm", "kinematic"}, {"base", "kinematic"}, {"friction", 0.8}}));
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
  EXPECT_EQ(found["options"]["seed"], 1);
  EXPECT_EQ(found["options"]["episode-steps"], 400);
  EXPECT_EQ(found["episodes"], 6);
  EXPECT_GE(found["success"]["simulation"]["count"], 4);
  EXPECT_THAT(one.out, Not(HasSubstr("apart after")));
}

TEST_F(DynamicsCli, GoesOnWhereItWasInterrupted) {
  const std::vector<std::string> words{"--policy", "scripted", "--report", "again.json"};
  ASSERT_EQ(run(words).exit_code, 0);
  const std::string whole = fileContent(path("again.json"));
  ASSERT_EQ(interrupted("again.json").exit_code, kExitInterrupted);
  changeFirstRecord(path("again.json.partial"), markRecord);
  ASSERT_EQ(run(words).exit_code, 0);
  const json before = json::parse(whole);
  const json after = report("again.json");
  EXPECT_GE(after["disturbed_objects"], kMark);
  EXPECT_EQ(after["success"], before["success"]);
}

TEST_F(DynamicsCli, BeginsAgainWhereItsOptionsAreOthers) {
  for (const auto& [option, value] :
       std::vector<std::pair<std::string, std::string>>{{"--arm", "kinematic"},
                                                        {"--base", "velocity"},
                                                        {"--friction", "0.7"},
                                                        {"--seed", "2"},
                                                        {"--set", "episode-steps=390"}}) {
    ASSERT_EQ(interrupted("other.json").exit_code, kExitInterrupted);
    changeFirstRecord(path("other.json.partial"), markRecord);
    const ProgramRun done = run({"--policy", "scripted", "--report", "other.json", option, value});
    ASSERT_EQ(done.exit_code, 0) << done.err;
    const json found = report("other.json");
    EXPECT_LT(found["disturbed_objects"], kMark) << option;
    EXPECT_THAT(found["options"].dump(), HasSubstr(value.substr(value.find('=') + 1))) << option;
  }
}

TEST_F(DynamicsCli, BeginsAgainWhereItsSourcesAreOthers) {
  const std::string data = copyOfSample("changing");
  const auto interrupt = [&] {
    EXPECT_EQ(interrupted("changed.json", data).exit_code, kExitInterrupted);
    changeFirstRecord(path("changed.json.partial"), markRecord);
  };
  const auto isMarked = [&](const std::string& program = builtProgram("galactic-dynamics")) {
    const ProgramRun done =
        run({"--policy", "scripted", "--report", "changed.json"}, data, program);
    EXPECT_EQ(done.exit_code, 0) << done.err;
    return report("changed.json")["disturbed_objects"] >= kMark;
  };
  interrupt();
  EXPECT_TRUE(isMarked()) << "nothing has changed";

  interrupt();
  write("changing/objects/mug.object_config.json", R"({"mass": 3})");
  EXPECT_FALSE(isMarked()) << "an object has a mass now, which had none";

  interrupt();
  write("changing/objects/mug.object_config.json", R"({"mass": 4})");
  EXPECT_FALSE(isMarked()) << "it has another";

  interrupt();
  append(path("changing/robot/porter.urdf"), "<!-- changed -->\n");
  EXPECT_FALSE(isMarked()) << "the robot is another";

  interrupt();
  append(path("home.toml"), "# changed\n");
  EXPECT_FALSE(isMarked()) << "the recipe is another";

  // What follows a program in its file changes nothing but its content.
  interrupt();
  const std::string program = path("another-build").string();
  std::filesystem::copy_file(builtProgram("galactic-dynamics"), program);
  append(program, "changed");
  EXPECT_FALSE(isMarked(program)) << "the program is another";
}

TEST_F(DynamicsCli, WarnsWhereThePacksWereBakedFromOtherSources) {
  const std::string data = copyOfSample("stale");
  const auto warnings = [&] {
    const ProgramRun done =
        run({"--policy", "scripted", "--episodes", "1", "--report", "stale.json"}, data);
    EXPECT_EQ(done.exit_code, 0) << done.err;
    std::vector<std::string> found;
    const json whole = report("stale.json");
    for (const json& warning : whole["warnings"]) {
      const auto text = warning.get<std::string>();
      if (text.find("was baked") != std::string::npos) found.push_back(text);
    }
    const bool is_printed = done.err.find("was baked") != std::string::npos;
    EXPECT_EQ(is_printed, !found.empty()) << done.err;
    return found;
  };
  EXPECT_THAT(warnings(), IsEmpty());

  const auto overwrite = std::filesystem::copy_options::overwrite_existing;
  std::filesystem::copy_file(path("stale/objects/bowl.glb"), path("stale/objects/mug.glb"),
                             overwrite);
  append(path("stale/robot/porter.urdf"), "<!-- changed -->\n");
  append(path("stale/robot/robot.toml"), "# changed\n");
  const std::string mug =
      "object 'mug' was baked from another 'mug.glb' than is there now; bake the world again";
  const std::vector<std::string> robot{
      "robot 'porter' was baked from another 'porter.urdf' than is there now; bake the world again",
      "robot 'porter' was baked from another 'robot.toml' than is there now; bake the world again"};
  EXPECT_THAT(warnings(), UnorderedElementsAre(mug, robot[0], robot[1]));

  // Also where the mesh is not read, as a collision asset takes its place.
  std::filesystem::create_directory(path("stale/pieces"));
  std::filesystem::copy_file(path("stale/objects/bowl.glb"), path("stale/pieces/mug.glb"));
  write("stale/configs/mug.object_config.json", R"({"collision_asset": "../pieces/mug.glb"})");
  EXPECT_THAT(warnings(), UnorderedElementsAre(mug, robot[0], robot[1]));
}

TEST_F(DynamicsCli, TakesTheHullOfTheMeshWhereNoPieceHasFourCorners) {
  const std::string data = copyOfSample("thin");
  write("thin/objects/sheet.obj", objFile({{{0, 0, 0}, {1, 0, 0}, {0, 0, 1}}, {{0, 1, 2}}}));
  const std::vector<std::string> words{"--recording", "home.rec", "--report", "thin.json"};
  ASSERT_EQ(run(words, data).exit_code, 0);
  const json plain = report("thin.json");
  for (const char* joined : {"false", "true"}) {
    write("thin/objects/mug.object_config.json",
          fmt::format(R"({{"mass": 0.5, "collision_asset": "sheet.obj",
                                    "join_collision_meshes": {}}})",
                      joined));
    const ProgramRun done = run(words, data);
    ASSERT_EQ(done.exit_code, 0) << done.err;
    EXPECT_THAT(done.err, HasSubstr("object 'mug' has the collision asset 'sheet.obj', no part of "
                                    "which has four corners; the hull of its mesh counts"));
    EXPECT_EQ(report("thin.json")["each"], plain["each"]);
  }
}

TEST_F(DynamicsCli, WarnsOfMassesAndFrictionsThatNoBodyHas) {
  const std::string data = copyOfSample("heavy");
  write("heavy/objects/mug.object_config.json", R"({"mass": 1e30, "friction_coefficient": 1e300})");
  std::string urdf = fileContent(path("heavy/robot/porter.urdf"));
  const std::string base = "<link name=\"base_link\">";
  urdf.insert(urdf.find(base) + base.size(),
              R"(<inertial><mass value="1e300"/>)"
              R"(<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>)");
  write("heavy/robot/porter.urdf", urdf);
  const std::vector<std::string> words{"--recording", "home.rec", "--report", "heavy.json"};
  ASSERT_EQ(run(words).exit_code, 0);
  const json plain = report("heavy.json");
  const ProgramRun done = run(words, data);
  ASSERT_EQ(done.exit_code, 0) << done.err;
  const json found = report("heavy.json");
  EXPECT_EQ(found["each"], plain["each"]);
  const std::string warnings = found["warnings"].dump();
  EXPECT_THAT(
      warnings,
      HasSubstr("object 'mug' has no usable 'mass' in 'mug.object_config.json': found 1e+30, "
                "expected 1e-06 to 1e+06; the default counts"));
  EXPECT_THAT(warnings,
              HasSubstr("has no usable 'friction_coefficient' in 'mug.object_config.json': "
                        "found 1e+300, expected 0 to 10; the default counts"));
  EXPECT_THAT(warnings, HasSubstr("link 'base_link' has a mass of 1e+300 kg in 'porter.urdf', "
                                  "expected 1e-06 to 1e+06; 23.6 kg count"));
}

TEST_F(DynamicsCli, RefusesCollisionAssetsThatAreFarTooLarge) {
  const std::string data = copyOfSample("large");
  // Whose sums are no numbers any more.
  constexpr float kHuge = 3e38F;
  write(
      "large/objects/huge.obj",
      objFile({{{0, 0, 0}, {kHuge, 0, 0}, {0, -kHuge, 0}, {0, 0, kHuge}}, {{0, 1, 2}, {0, 2, 3}}}));
  write("large/objects/mug.object_config.json", R"({"collision_asset": "huge.obj"})");
  const ProgramRun done = run({"--recording", "home.rec"}, data);
  EXPECT_EQ(done.exit_code, kInvalid);
  EXPECT_THAT(done.err,
              HasSubstr("huge.obj: it reaches 3e+38 m from the origin, but only 800 m are "
                        "possible; is its unit the meter?"));
}

TEST_F(DynamicsCli, SaysHowToGoOnWhenItIsInterrupted) {
  const ProgramRun stopped = interrupted("stopped.json", sample(), "HUP");
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

TEST_F(DynamicsCli, ShowsTheFirstEpisodesWhereNothingPartsTheWorlds) {
  // In two steps nobody gets to grasp, let go or touch anything.
  const ProgramRun done = run({"--policy", "scripted", "--set", "episode-steps=2", "--quiet",
                               "--view", "calm.html", "--pictures", "calm.png"});
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(fileContent(path("calm.html")), HasSubstr("<title>calm</title>"));
  EXPECT_FALSE(std::filesystem::exists(path("calm.png")));
  EXPECT_EQ(done.err,
            "galactic-dynamics: calm.png is not written: there is no moment to draw, as in no "
            "episode a success is lost, a contact missed, or anything more than 2 cm from where "
            "the simulation has it\n");
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
      {{"--policy", "scripted", "--set", "motion-noise=0.1"}, 5, "--set motion-noise=0"},
      {{"--policy", "scripted", "--set", "action-delay=0-2"}, 5, "--set action-delay=0"},
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

TEST_F(DynamicsCli, PlaysAWorldWhoseNoiseOfMotionIsSwitchedOff) {
  std::ofstream(path("noisy.toml"))
      << fileContent(path("home.toml")) << "[task]\nmotion-noise = 0.1\nmotion-bias = 0.05\n";
  const std::filesystem::path folder = path("").parent_path();
  const ProgramRun baked =
      runProgram(builtProgram("galactic-bake"), folder, {"noisy.toml", "--data", sample()});
  ASSERT_EQ(baked.exit_code, 0) << baked.err;
  const auto play = [&](const std::string& name, const std::vector<std::string>& more) {
    std::vector<std::string> words{name + ".toml", name + ".pack", "--data",     sample(),
                                   "--policy",     "scripted",     "--episodes", "1"};
    words.insert(words.end(), more.begin(), more.end());
    return runProgram(builtProgram("galactic-dynamics"), folder, words);
  };
  EXPECT_EQ(play("noisy", {}).exit_code, 5);
  EXPECT_EQ(play("noisy", {"--set", "motion-noise=0"}).exit_code, 5);
  const ProgramRun done = play("noisy", {"--set", "motion-noise=0", "--set", "motion-bias=0"});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_EQ(done.out, play("home", {}).out);
}

TEST_F(DynamicsCli, ReplacesNothingThatIsReadOrWritten) {
  // Its own sources, so that nothing is lost if one is replaced.
  ASSERT_EQ(copyOfSample("sources"), "sources");
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
    const ProgramRun done =
        runProgram(builtProgram("galactic-dynamics"), path("").parent_path(), arguments);
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
    const ProgramRun done = runRedirected(builtProgram("galactic-dynamics"), path("").parent_path(),
                                          {"--nonsense"}, unheard);
    EXPECT_EQ(done.exit_code, kUsage) << unheard;
  }
}

TEST_F(DynamicsCli, TriesItsOutputsBeforeTheWork) {
  const std::vector<std::pair<std::string, std::string>> outputs{
      {"--view", "no/such/folder/both.html"}, {"--pictures", "no/such/folder/both.png"}};
  for (const auto& [option, file] : outputs) {
    const ProgramRun done = run({"--policy", "scripted", "--report", "tried.json", option, file});
    EXPECT_EQ(done.exit_code, 2) << done.err;
    EXPECT_TRUE(done.out.empty()) << done.out;
    EXPECT_FALSE(std::filesystem::exists(path("tried.json.partial"))) << option;
  }
  const ProgramRun report = run({"--policy", "scripted", "--report", "no/such/folder/file"});
  EXPECT_EQ(report.exit_code, 2) << report.err;
  EXPECT_TRUE(report.out.empty()) << report.out;
}

TEST_F(DynamicsCli, WritesPagesAndPicturesUnderNamesThatSayWhatTheyAre) {
  struct Misnamed {
    const char* option;
    const char* file;
    const char* message;
  };
  for (const auto& [option, file, message] :
       {Misnamed{"--view", "page.png", "page.png: pages are HTML files; end the name with .html"},
        {"--pictures", "sheet.jpg", "sheet.jpg: pictures are PNG files; end the name with .png"},
        {"--pictures", "sheet", "sheet: pictures are PNG files; end the name with .png"}}) {
    const ProgramRun done = run({"--policy", "scripted", option, file});
    EXPECT_EQ(done.exit_code, 5) << done.err;
    EXPECT_THAT(done.err, HasSubstr(message));
    EXPECT_TRUE(done.out.empty()) << done.out;
    EXPECT_FALSE(std::filesystem::exists(path(file)));
  }
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
  const ProgramRun done = runProgram(builtProgram("galactic-dynamics"), path("").parent_path(),
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
