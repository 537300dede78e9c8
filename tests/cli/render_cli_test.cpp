// Drawing with galactic-run as a user meets it: files, report, exit codes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>
#include <thread>
#include <tuple>
#include <utility>
#include <vector>

#include "galactic/error.h"
#include "support/build_paths.h"
#include "support/file_content.h"
#include "support/homes/small_home_models.h"
#include "support/program_run.h"
#include "support/scratch_folder.h"

namespace galactic::render_cli_test {
namespace {

using nlohmann::json;
using test::ProgramRun;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

/// The small home with render meshes, drawn by the soft renderer.
class RenderCli : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(
        std::filesystem::exists(test::writeWorld(folder_, test::smallHomeWorldWithModels())));
  }

  [[nodiscard]] ProgramRun runBare(std::vector<std::string> arguments) const {
    return test::runProgram(test::builtProgram("galactic-run"), folder_.path(),
                            std::move(arguments));
  }
  [[nodiscard]] ProgramRun run(std::vector<std::string> arguments) const {
    const std::vector<std::string> first{"world.pack", "--backend", "soft", "--envs",
                                         "3",          "--steps",   "20"};
    arguments.insert(arguments.begin(), first.begin(), first.end());
    return runBare(std::move(arguments));
  }
  [[nodiscard]] std::string content(const std::string& name) const {
    return test::fileContent(folder_.path() / name);
  }
  [[nodiscard]] std::vector<std::string> files(const std::string& folder) const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path() / folder)) {
      names.push_back(entry.path().filename().string());
    }
    std::sort(names.begin(), names.end());
    return names;
  }

  test::ScratchFolder folder_;
};

TEST_F(RenderCli, DrawsAndSaysHowFast) {
  const ProgramRun result = run({"--render", "rgbd", "--size", "32x24"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out,
              AllOf(HasSubstr("\n  drawing       rgbd 32 x 24, camera head, by soft, "),
                    HasSubstr(" images/s"), HasSubstr(" ms of rendering, "),
                    HasSubstr("\n    overlapped  "), HasSubstr(" of the larger part\n")));
  EXPECT_THAT(result.err, IsEmpty());
  EXPECT_THAT(files("."), ElementsAre("episodes.pack", "objects.pack", "robots", "scenes",
                                      "stderr.txt", "stdout.txt", "world.pack"));
}

TEST_F(RenderCli, ReportsAsJson) {
  const ProgramRun result =
      run({"--render", "rgbds", "--size", "16", "--camera", "hand", "--report", "report.json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json report = json::parse(content("report.json"));
  const json& rendering = report["rendering"];
  EXPECT_EQ(rendering["backend"], "soft");
  EXPECT_THAT(rendering["description"].get<std::string>(), StartsWith("soft"));
  EXPECT_EQ(rendering["image_count"], 60);
  EXPECT_EQ(rendering["semantics"][0], "background");
  EXPECT_GT(rendering["images_per_second"].get<double>(), 0);
  for (const char* part : {"rendering_alone", "physics_alone", "overlapped"}) {
    EXPECT_GT(rendering["seconds_per_step"][part].get<double>(), 0) << part;
  }
  ASSERT_EQ(run({"--report", "plain.json"}).exit_code, 1);
  ASSERT_EQ(runBare({"world.pack", "--steps", "3", "--report", "plain.json"}).exit_code, 0);
  EXPECT_FALSE(json::parse(content("plain.json")).contains("rendering"));
}

TEST_F(RenderCli, ReportsEveryOptionOfTheCommandLine) {
  ASSERT_EQ(
      runBare({"world.pack", "--steps", "3", "--envs", "2", "--report", "plain.json"}).exit_code,
      0);
  const json plain = json::parse(content("plain.json"))["options"];
  // What ends at once, what the report has beside its options, the opposite of --deterministic, and
  // what stands for other options.
  const std::vector<std::string> others{"help", "version", "pack", "sampled", "slide"};
  const std::string help = runBare({"--help"}).out;
  std::size_t options = 0;
  const std::regex option(R"(\n +(?:-\w,)?--([a-z-]+))");
  for (std::sregex_iterator at(help.begin(), help.end(), option), end; at != end; ++at) {
    const std::string name = (*at)[1];
    const bool is_other = std::ranges::find(others, name) != others.end();
    EXPECT_NE(plain.contains(name), is_other) << name;
    ++options;
  }
  EXPECT_GT(options, 90U);
  EXPECT_EQ(plain["steps"], 3);
  for (const char* untyped : {"render", "device", "fov", "near", "eye", "frames", "record"}) {
    EXPECT_TRUE(plain[untyped].is_null()) << untyped;
  }
}

TEST_F(RenderCli, ReportsOptionsAsTheyAreTyped) {
  const std::vector<std::string> typed{
      "--render",       "rgb",      "--size",         "24x16",        "--camera",
      "hand",           "--fov",    "75.5",           "--near",       "0.2",
      "--frame-every",  "8",        "--camera-rpy",   "0,-20.5,90",   "--camera-position",
      "-0.1,0,0.2",     "--frames", "first",          "--frame-envs", "2",
      "--debug-camera", "top",      "--debug-radius", "0.05",         "--debug-view=true"};
  std::vector<std::string> all = typed;
  all.insert(all.end(), {"--report", "typed.json"});
  const ProgramRun result = run(all);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json options = json::parse(content("typed.json"))["options"];
  EXPECT_EQ(options["backend"], "soft");
  EXPECT_EQ(options["debug-view"], true);
  for (std::size_t n = 0; n + 1 < typed.size(); n += 2) {
    const json& told = options[typed[n].substr(2)];
    EXPECT_EQ(told.is_string() ? told.get<std::string>() : told.dump(), typed[n + 1]) << typed[n];
  }
}

TEST_F(RenderCli, WritesFramesAndASheetThatDependOnNothingElse) {
  const std::vector<std::string> pictures{
      "--render", "rgbds",        "--size", "24x16", "--frame-every", "8", "--frame-envs",
      "2",        "--debug-view", "--seed", "4"};
  const auto with = [&](const std::string& folder, const std::string& threads) {
    std::vector<std::string> all = pictures;
    all.insert(all.end(),
               {"--threads", threads, "--frames", folder, "--contact-sheet", folder + ".png"});
    return run(all);
  };
  const ProgramRun one = with("one", "1");
  ASSERT_EQ(one.exit_code, 0) << one.err;
  ASSERT_EQ(with("three", "3").exit_code, 0);
  const std::vector<std::string> names = files("one");
  // States 0, 8 and 16 of two envs, four images and a camera each.
  EXPECT_EQ(names.size(), 3U * 2 * 5 + 1) << "and the legend of the semantic ids";
  const json camera = json::parse(content("one/env_0001_step_000016_camera.json"));
  EXPECT_EQ(camera["intrinsics"][0][2], 12);
  EXPECT_EQ(camera["intrinsics"][1][2], 8);
  EXPECT_EQ(camera["intrinsics"][0][0], camera["intrinsics"][1][1]);
  EXPECT_EQ(camera["world_from_camera"].size(), 4U);
  EXPECT_NE(content("one/env_0001_step_000016_camera.json"),
            content("one/env_0001_step_000000_camera.json"));
  EXPECT_THAT(names, AllOf(testing::Contains("env_0001_step_000016_rgb.png"),
                           testing::Contains("env_0000_step_000008_depth.png"),
                           testing::Contains("env_0000_step_000000_semantic.png"),
                           testing::Contains("env_0001_step_000000_debug.png")));
  EXPECT_EQ(files("three"), names);
  for (const std::string& name : names) {
    EXPECT_EQ(content("one/" + name), content("three/" + name)) << name;
  }
  EXPECT_EQ(content("one.png"), content("three.png"));
  EXPECT_THAT(content("one.png"), StartsWith("\x89PNG"));
  const json legend = json::parse(content("one/semantics.json"))["semantics"];
  ASSERT_GT(legend.size(), 1U);
  for (std::size_t id = 0; id < legend.size(); ++id) {
    EXPECT_EQ(legend[id]["id"], id);
    EXPECT_THAT(legend[id]["name"].get<std::string>(), Not(IsEmpty()));
    EXPECT_THAT(legend[id]["color"].get<std::string>(), testing::MatchesRegex("#[0-9a-f]{6}"));
  }
  EXPECT_EQ(legend[0]["name"], "background");
  EXPECT_EQ(legend[0]["color"], "#000000");
  // The robot has moved.
  EXPECT_NE(content("one/env_0000_step_000000_rgb.png"),
            content("one/env_0000_step_000016_rgb.png"));
}

TEST_F(RenderCli, DrawingDoesNotChangeTheRun) {
  const std::vector<std::string> plain{"world.pack", "--envs", "3", "--steps",
                                       "40",         "--seed", "9", "--record"};
  std::vector<std::string> without = plain;
  without.insert(without.end(), {"plain.rec"});
  std::vector<std::string> drawn = plain;
  drawn.insert(drawn.end(), {"drawn.rec", "--render", "rgbd", "--size", "16", "--backend", "soft"});
  ASSERT_EQ(runBare(without).exit_code, 0);
  ASSERT_EQ(runBare(drawn).exit_code, 0);
  EXPECT_EQ(content("plain.rec"), content("drawn.rec"));
  // And a recording can be drawn.
  const ProgramRun replayed =
      runBare({"world.pack", "--policy", "replay:plain.rec", "--render", "rgb", "--size", "16",
               "--backend", "soft", "--contact-sheet", "replay.png"});
  EXPECT_EQ(replayed.exit_code, 0) << replayed.err;
  EXPECT_THAT(content("replay.png"), StartsWith("\x89PNG"));
}

TEST_F(RenderCli, AddsNoiseThatDependsOnSeedEnvEpisodeAndStepAlone) {
  const std::vector<std::string> noise{
      "--depth-noise",  "0.02", "--depth-dropout", "0.02-0.3", "--color-noise",           "8",
      "--light-jitter", "0.4",  "--camera-jitter", "0.02",     "--camera-jitter-degrees", "3"};
  const auto drawn = [&](const std::string& folder, const std::vector<std::string>& batch,
                         bool is_noisy) {
    std::vector<std::string> all{
        "world.pack", "--backend",      "soft",     "--steps",      "9",
        "--render",   "rgbds",          "--size",   "24x16",        "--frames",
        folder,       "--frame-every",  "8",        "--frame-envs", "2",
        "--report",   folder + ".json", "--record", folder + ".rec"};
    all.insert(all.end(), batch.begin(), batch.end());
    if (is_noisy) all.insert(all.end(), noise.begin(), noise.end());
    const ProgramRun result = runBare(all);
    EXPECT_EQ(result.exit_code, 0) << result.err;
  };
  drawn("plain", {"--envs", "3"}, false);
  drawn("noisy", {"--envs", "3", "--threads", "1"}, true);
  drawn("larger", {"--envs", "7", "--threads", "3"}, true);
  drawn("seeded", {"--envs", "3", "--seed", "2"}, true);
  EXPECT_EQ(content("plain.rec"), content("noisy.rec")) << "noise changes nothing in the run";
  for (const std::string& name : files("noisy")) {
    EXPECT_EQ(content("noisy/" + name), content("larger/" + name)) << name;
    if (name == "semantics.json") continue;
    EXPECT_NE(content("noisy/" + name), content("plain/" + name)) << name;
    EXPECT_NE(content("noisy/" + name), content("seeded/" + name)) << name;
  }
  EXPECT_EQ(json::parse(content("plain.json"))["options"]["depth-noise"], 0);
  const json told = json::parse(content("noisy.json"))["options"];
  EXPECT_EQ(told["depth-noise"], 0.02);
  EXPECT_EQ(told["depth-dropout"], "0.02-0.3");
  EXPECT_EQ(told["camera-jitter-degrees"], 3);
}

TEST_F(RenderCli, RefusesNoiseThatNobodyWouldSee) {
  struct Refusal {
    std::vector<std::string> arguments;
    std::string message;
  };
  const std::vector<Refusal> refusals{
      {{"--render", "rgb", "--depth-noise", "0.1"},
       "--depth-noise applies to depth only; draw it with --render rgbd, or leave --depth-noise "
       "out"},
      {{"--render", "depth", "--light-jitter", "0.1"},
       "--light-jitter applies to color only; draw it with --render rgbd, or leave --light-jitter "
       "out"},
      {{"--depth-dropout", "0.1"}, "--depth-dropout applies to rendering only; add --render"},
      {{"--render", "rgb", "--color-noise", "300"},
       "--color-noise: found 300, expected 0 to 255, or a range from 0 to 255 such as 0.1-0.3"},
      {{"--render", "rgb", "--color-noise", "30-20"},
       "--color-noise: found 30-20, expected 0 to 255, or a range from 0 to 255 such as 0.1-0.3"}};
  for (const Refusal& refusal : refusals) {
    std::vector<std::string> all{"world.pack"};
    all.insert(all.end(), refusal.arguments.begin(), refusal.arguments.end());
    const ProgramRun result = runBare(all);
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_EQ(result.err, "galactic-run: command line: " + refusal.message + "; see --help\n");
  }
}

TEST_F(RenderCli, DrawsFromAPlaceInTheHome) {
  const ProgramRun result =
      run({"--render", "rgbd", "--size", "24x16", "--eye", "0.3,2.2,0.3", "--look-at", "2,0.3,2",
           "--frames", "room", "--frame-every", "8", "--report", "room.json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json camera = json::parse(content("room/env_0001_step_000016_camera.json"));
  const json& matrix = camera["world_from_camera"];
  EXPECT_NEAR(matrix[0][3].get<double>(), 0.3, 1e-6);
  EXPECT_NEAR(matrix[1][3].get<double>(), 2.2, 1e-6);
  EXPECT_NEAR(matrix[2][3].get<double>(), 0.3, 1e-6);
  EXPECT_LT(matrix[1][2].get<double>(), 0) << "it looks down";
  EXPECT_EQ(content("room/env_0001_step_000016_camera.json"),
            content("room/env_0000_step_000000_camera.json"));
  EXPECT_NE(content("room/env_0000_step_000016_rgb.png"),
            content("room/env_0000_step_000000_rgb.png"))
      << "the robot moves";
  const json options = json::parse(content("room.json"))["options"];
  EXPECT_EQ(options["eye"], "0.3,2.2,0.3");
  EXPECT_EQ(options["look-at"], "2,0.3,2");
}

TEST_F(RenderCli, RefusesTwoPlacesOfOneCamera) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> refusals{
      {{"--eye", "1,2,3"}, "--eye needs --look-at, what the camera looks at; add it"},
      {{"--look-at", "1,2,3"}, "--look-at needs --eye, where the camera stands; add it"},
      {{"--eye", "1,2,3", "--look-at", "1,2.0,3"},
       "--look-at is where --eye is, at 1,2,3; give another point"},
      {{"--eye", "1,2,3", "--look-at", "0,0,0", "--camera", "head"},
       "--camera places the camera on the robot, and --eye in the home; leave one out"},
      {{"--eye", "1,2,3", "--look-at", "0,0,0", "--camera-rpy", "0,9,0"},
       "--camera-rpy places the camera on the robot, and --eye in the home; leave one out"},
      {{"--eye", "1,2", "--look-at", "0,0,0"},
       "--eye: found 1,2, expected three numbers from -10000 to 10000 with commas between"}};
  for (const auto& [arguments, message] : refusals) {
    std::vector<std::string> all{"world.pack", "--render", "rgb"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const ProgramRun result = runBare(all);
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_EQ(result.err, "galactic-run: command line: " + message + "; see --help\n");
  }
}

TEST_F(RenderCli, SendsAVideoToFfmpeg) {
  const auto script =
      folder_.write("bin/ffmpeg", "#!/bin/sh\nfor last; do :; done\ncat > \"$last\"\n");
  std::filesystem::permissions(script, std::filesystem::perms::owner_all);
  const std::string before = std::getenv("PATH");
  ::setenv("PATH", ((folder_.path() / "bin").string() + ":" + before).c_str(), 1);
  const ProgramRun result = run({"--render", "rgb", "--size", "16", "--video", "run.mp4"});
  ::setenv("PATH", (folder_.path() / "empty").c_str(), 1);
  const ProgramRun without = run({"--render", "rgb", "--size", "16", "--video", "other.mp4"});
  ::setenv("PATH", before.c_str(), 1);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  // States 0 to 20 as a square of 2 x 2 tiles, one of them empty.
  EXPECT_EQ(content("run.mp4").size(), 21U * 34 * 34 * 3);
  EXPECT_EQ(without.exit_code, 5);
  EXPECT_EQ(without.err,
            "galactic-run: other.mp4: needs ffmpeg, which is not on PATH; install it, or take "
            "--frames instead\n");
}

TEST_F(RenderCli, WhatCannotWorkIsRefusedBeforeTheRun) {
  static_cast<void>(folder_.write("occupied", "a file"));
  const std::vector<std::tuple<std::vector<std::string>, int, std::string>> mistakes{
      {{"--render", "rgb", "--camera", "nose"},
       3,
       "galactic-run: --camera: found no link \"nose\""},
      {{"--render", "rgb", "--frames", "f", "--debug-view", "--debug-camera", "nose"},
       3,
       "galactic-run: --debug-camera: found no link \"nose\""},
      {{"--render", "rgb", "--frames", "f", "--debug-view", "--debug-radius", "0.3"},
       3,
       "galactic-run: debug view: found a radius of 0.3 m"},
      {{"--render", "rgb", "--frames", "occupied"}, 2, "galactic-run: occupied: "},
      {{"--render", "rgb", "--contact-sheet", "none/a.png"}, 2, "galactic-run: none/a.png: "},
      {{"--render", "rgb", "--video", "none/a.mp4"}, 2, "galactic-run: none/a.mp4: "},
      {{"--frames", "f"}, 1, "galactic-run: command line: "},
  };
  for (const auto& [arguments, code, message] : mistakes) {
    const ProgramRun result = run(arguments);
    EXPECT_EQ(result.exit_code, code) << result.err;
    EXPECT_THAT(result.err, StartsWith(message));
    EXPECT_THAT(result.out, IsEmpty());
  }
}

TEST_F(RenderCli, TheProcessorDoesNotDrawForADeviceThatIsNamed) {
  const auto refusal_of = [&](const char* device) {
    return runBare(
        {"world.pack", "--envs", "1", "--steps", "1", "--render", "rgb", "--device", device});
  };
  const ProgramRun missing = refusal_of("99");
  EXPECT_EQ(missing.exit_code, 5);
  EXPECT_THAT(missing.err, StartsWith("galactic-run: render device: neither gl nor cuda draws on "
                                      "it. gl: "));
  EXPECT_EQ(runBare({"world.pack", "--envs", "1", "--steps", "1", "--render", "rgb"}).exit_code, 0);
}

TEST_F(RenderCli, ASheetThatIsTooLargeIsRefusedBeforeTheRun) {
  const ProgramRun result = runBare(
      {"world.pack", "--backend", "soft", "--envs", "300", "--frame-envs", "300", "--steps", "1",
       "--render", "rgb", "--size", "4096x1", "--contact-sheet", "a.png", "--record", "a.rec"});
  EXPECT_EQ(result.exit_code, 5);
  EXPECT_EQ(
      result.err,
      "galactic-run: a.png: would be a picture of 1231208 x 92 pixels, and viewers show up to "
      "16384 along a side; show at most 3 of its 300 envs (--frame-envs)\n");
  EXPECT_THAT(result.out, IsEmpty());
}

TEST_F(RenderCli, NamesOfPicturesAndAnimationsSayWhatTheyAre) {
  for (const char* name : {"sheet.jpg", "sheet", "sheet.png.bak"}) {
    const ProgramRun sheet = run({"--render", "rgb", "--contact-sheet", name});
    EXPECT_EQ(sheet.exit_code, 5) << name;
    EXPECT_EQ(sheet.err, "galactic-run: " + std::string(name) +
                             ": pictures are PNG files; end the name with .png\n");
  }
  for (const char* name : {"run.fbx", "run.gltf"}) {
    const ProgramRun animation = run({"--render", "rgb", "--animation", name});
    EXPECT_EQ(animation.exit_code, 5) << name;
    EXPECT_EQ(animation.err, "galactic-run: " + std::string(name) +
                                 ": animations are binary glTF files; end the name with .glb\n");
  }
  EXPECT_EQ(run({"--render", "rgb", "--animation", "run.GLB"}).exit_code, 0);
}

TEST_F(RenderCli, PicturesReplaceNothingThatIsReadOrWritten) {
  const std::string kitchen = "scenes/kitchen.pack";
  const std::string before = content(kitchen);
  std::filesystem::create_directories(folder_.path() / "linked");
  std::filesystem::create_symlink(folder_.path() / kitchen,
                                  folder_.path() / "linked/env_0000_step_000000_rgb.png");
  const std::string twice = "would be written twice: by ";
  const std::vector<std::pair<std::vector<std::string>, std::string>> attempts{
      {{"--contact-sheet", kitchen}, kitchen + ": is also an input; write to another file"},
      {{"--video", kitchen}, kitchen + ": is also an input; write to another file"},
      {{"--frames", "linked"},
       "linked/env_0000_step_000000_rgb.png: is also an input; write to another file"},
      {{"--frames", "f", "--report", "./f/semantics.json"},
       "f/semantics.json: " + twice + "--report and by --frames; give each its own name"},
      {{"--frames", "f", "--contact-sheet", "f"},
       "f: " + twice + "--contact-sheet and by --frames; give each its own name"},
      {{"--video", "a.mp4", "--contact-sheet", "a.mp4"},
       "a.mp4: " + twice + "--contact-sheet and by --video; give each its own name"},
  };
  for (const auto& [arguments, message] : attempts) {
    std::vector<std::string> all{"--render", "rgb"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const ProgramRun result = run(all);
    EXPECT_EQ(result.exit_code, 3) << message;
    EXPECT_EQ(result.err, "galactic-run: " + message + "\n");
    EXPECT_THAT(result.out, IsEmpty());
  }
  EXPECT_TRUE(content(kitchen) == before);
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "f"));
}

TEST_F(RenderCli, OtherFilesMayLieAmongTheFrames) {
  const std::vector<std::string> all{"--render", "rgb",      "--size",   "16",
                                     "--frames", "new/f",    "--report", "new/f/report.json",
                                     "--record", "new/f/rec"};
  EXPECT_EQ(run(all).exit_code, 0);
  // Again, over what is there.
  const ProgramRun again = run(all);
  EXPECT_EQ(again.exit_code, 0) << again.err;
}

TEST_F(RenderCli, AWorldWithoutRenderMeshesIsRefusedByItsPack) {
  ASSERT_TRUE(std::filesystem::exists(test::writeWorld(folder_, test::smallHomeWorld())));
  const ProgramRun result = run({"--render", "rgb"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.err, AllOf(StartsWith("galactic-run: "), HasSubstr(".pack: "),
                                HasSubstr("was baked without render meshes")));
}

TEST_F(RenderCli, ARunThatIsStoppedFinishesItsPictures) {
  // A signal that comes early waits until it is asked for. Without --foreground, timeout sends a
  // second one to its whole group, which may end the run at once.
  const ProgramRun result = test::runProgram("/usr/bin/timeout", folder_.path(),
                                             {"--foreground",
                                              "--preserve-status",
                                              "-s",
                                              "INT",
                                              "2",
                                              test::builtProgram("galactic-run"),
                                              "world.pack",
                                              "--backend",
                                              "soft",
                                              "--envs",
                                              "2",
                                              "--steps",
                                              "1000000000",
                                              "--render",
                                              "rgb",
                                              "--size",
                                              "16",
                                              "--frames",
                                              "frames",
                                              "--frame-every",
                                              "1000",
                                              "--contact-sheet",
                                              "sheet.png"});
  EXPECT_EQ(result.exit_code, kExitInterrupted) << result.err;
  EXPECT_THAT(result.out, HasSubstr("(stopped; 1000000000 steps were asked for)"));
  EXPECT_THAT(content("sheet.png"), StartsWith("\x89PNG"));
  EXPECT_THAT(files("frames"), testing::Contains("env_0001_step_000000_rgb.png"));
}

TEST_F(RenderCli, ASecondSignalEndsARunAtOnceThatHasMuchToFinish) {
  // It waits for an ffmpeg that takes its time. What that says must not grow: whoever reads a file
  // that grows as fast never comes to its end.
  const auto script =
      folder_.write("bin/ffmpeg", "#!/bin/sh\nhead -c 1 > begun\ncat > /dev/null\nsleep 20\n");
  std::filesystem::permissions(script, std::filesystem::perms::owner_all);
  const std::string before = std::getenv("PATH");
  ::setenv("PATH", ((folder_.path() / "bin").string() + ":" + before).c_str(), 1);
  const test::StartedProgram started(
      test::builtProgram("galactic-run"), folder_.path(),
      {"world.pack", "--backend", "soft", "--envs", "1", "--steps", "1000000000", "--render", "rgb",
       "--size", "16", "--video", "run.mp4", "--record", "run.rec"});
  ::setenv("PATH", before.c_str(), 1);
  const auto has_begun = [&] { return !content("begun").empty(); };
  for (int n = 0; n < 2000 && !has_begun(); ++n) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  started.signal(SIGINT);
  // The same request, by another way.
  started.signal(SIGTERM);
  std::this_thread::sleep_for(std::chrono::seconds(1));
  started.signal(SIGTERM);
  const ProgramRun result = started.wait();
  EXPECT_EQ(result.exit_code, kExitInterrupted) << result.err;
  EXPECT_EQ(result.err, "\ngalactic-run: finishing what has begun; once more to stop at once\n");
  EXPECT_THAT(result.out, IsEmpty());
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "run.mp4"));
}

}  // namespace
}  // namespace galactic::render_cli_test
