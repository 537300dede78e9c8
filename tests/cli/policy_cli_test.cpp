// Policy packs with galactic-run as a user meets them: what is played, drawn, recorded and refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "support/build_paths.h"
#include "support/file_content.h"
#include "support/homes/policy_networks.h"
#include "support/homes/small_home_models.h"
#include "support/program_run.h"
#include "support/scratch_folder.h"

namespace galactic::policy_cli_test {
namespace {

using nlohmann::json;
using test::ProgramRun;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

/// The joints that actions move in the small home.
constexpr std::uint32_t kJoints = 4;

/// A policy for the small home's robot: with images, they decide, too.
PolicyContent homePolicy(bool has_image) {
  test::PolicyBuilder b(3);
  b.content.interface.name = "wanderer";
  b.content.interface.robot = "helper";
  b.content.interface.options = {{.name = "task", .value = "pick"},
                                 {.name = "episode-steps", .value = "7"}};
  b.content.interface.observation = test::plainObservation(kJoints);
  std::uint32_t x = b.add({{}, layer::Observation{}});
  std::uint32_t size = 19 + kJoints;
  if (has_image) {
    b.content.interface.image = PolicyImage{.width = 16, .height = 12};
    std::uint32_t seen = b.add({{}, layer::Image{}});
    seen = b.convolution(seen, {.inputs = 4, .outputs = 8, .size = 4, .stride = 4, .bias = true});
    seen = b.linear(b.relu(seen), 8 * 4 * 3, 10);
    x = b.add({{x, seen}, layer::Concatenate{}});
    size += 10;
  }
  b.heads(b.gru(x, size, 12), 12, kJoints + 2);
  return std::move(b.content);
}

class PolicyCli : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(
        std::filesystem::exists(test::writeWorld(folder_, test::smallHomeWorldWithModels())));
    write("blind.pack", homePolicy(false));
    write("seeing.pack", homePolicy(true));
  }

  void write(const std::string& name, const PolicyContent& content) const {
    const auto written =
        writePolicyPack(folder_.path() / name, content, test::smallPolicyProvenance());
    ASSERT_TRUE(written.has_value()) << written.error().text();
  }
  [[nodiscard]] ProgramRun runBare(std::vector<std::string> arguments) const {
    return test::runProgram(test::builtProgram("galactic-run"), folder_.path(),
                            std::move(arguments));
  }
  [[nodiscard]] ProgramRun run(std::vector<std::string> arguments) const {
    const std::vector<std::string> first{"world.pack", "--envs", "5", "--steps", "20"};
    arguments.insert(arguments.begin(), first.begin(), first.end());
    return runBare(std::move(arguments));
  }
  [[nodiscard]] std::string content(const std::string& name) const {
    return test::fileContent(folder_.path() / name);
  }
  /// The recording of a run: its actions and what came of them.
  [[nodiscard]] std::string recordingOf(std::vector<std::string> arguments) const {
    arguments.insert(arguments.end(), {"--record", "run.rec"});
    const ProgramRun result = run(std::move(arguments));
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return content("run.rec");
  }

  test::ScratchFolder folder_;
};

TEST_F(PolicyCli, PlaysAPackAndNamesIt) {
  const ProgramRun result = run({"--policy", "blind.pack", "--report", "report.json"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, StartsWith("5 envs, 20 steps each, "));
  EXPECT_THAT(result.out, AllOf(HasSubstr("policy blind.pack, seed 1\n"),
                                HasSubstr("\n  learned       wanderer, its sampled actions; "),
                                HasSubstr(" us per env and step\n")));
  EXPECT_THAT(result.err, IsEmpty());
  const json report = json::parse(content("report.json"));
  EXPECT_EQ(report["policy"], "blind.pack");
  EXPECT_EQ(report["learned"]["name"], "wanderer");
  EXPECT_EQ(report["learned"]["samples"], true);
  EXPECT_GT(report["learned"]["seconds"], 0);
}

TEST_F(PolicyCli, TakesTheOptionsThatThePolicyNeedsUnlessOthersAreTyped) {
  ASSERT_EQ(run({"--policy", "blind.pack", "--report", "report.json"}).exit_code, 0);
  json options = json::parse(content("report.json"))["options"];
  EXPECT_EQ(options["task"], "pick");
  EXPECT_EQ(options["episode-steps"], 7);
  ASSERT_EQ(
      run({"--policy", "blind.pack", "--episode-steps", "9", "--report", "report.json"}).exit_code,
      0);
  options = json::parse(content("report.json"))["options"];
  EXPECT_EQ(options["task"], "pick");
  EXPECT_EQ(options["episode-steps"], 9);
}

TEST_F(PolicyCli, DrawsWhatThePolicyWantsToSee) {
  // The recordings have other actions as soon as anything is seen.
  const std::string once = recordingOf({"--policy", "seeing.pack", "--backend", "soft"});
  EXPECT_TRUE(recordingOf({"--policy", "seeing.pack", "--backend", "soft", "--threads", "1"}) ==
              once)
      << "the same on any number of threads";
}

TEST_F(PolicyCli, SeesFromWhereThePolicyWasTrained) {
  const auto seen = [&](const std::function<void(PolicyImage&)>& change) {
    PolicyContent content = homePolicy(true);
    change(*content.interface.image);
    write("placed.pack", content);
    return recordingOf({"--policy", "placed.pack", "--backend", "soft", "--deterministic"});
  };
  const std::vector<std::string> views{seen([](PolicyImage&) {}), seen([](PolicyImage& image) {
                                         image.position = {0, 0, 0.3F};
                                       }),
                                       seen([](PolicyImage& image) {
                                         image.rpy_degrees = {0, 0, 45};
                                       }),
                                       seen([](PolicyImage& image) { image.near = 1; })};
  EXPECT_EQ(std::set<std::string>(views.begin(), views.end()).size(), views.size());
}

TEST_F(PolicyCli, SeesNoiseAndJitterWhereTheyAreAskedFor) {
  const auto seen = [&](std::vector<std::string> noise) {
    noise.insert(noise.end(), {"--policy", "seeing.pack", "--backend", "soft", "--deterministic"});
    return recordingOf(noise);
  };
  const std::string plain = seen({});
  const std::set<std::string> all{plain, seen({"--depth-noise", "0.1"}),
                                  seen({"--color-noise", "40"}), seen({"--light-jitter", "0.8"}),
                                  seen({"--camera-jitter", "0.2"})};
  EXPECT_EQ(all.size(), 5U);
  EXPECT_TRUE(seen({"--depth-noise", "0"}) == plain);
  EXPECT_FALSE(all.contains(seen({"--depth-noise", "0.05-0.2"})));
  EXPECT_FALSE(all.contains(seen({"--camera-jitter-fov", "20"})));
  // Also beside images for people of another kind.
  EXPECT_TRUE(all.contains(seen({"--color-noise", "40", "--render", "depth", "--size", "16"})));
}

TEST_F(PolicyCli, DrawsActionsOrTakesTheLikeliest) {
  const std::string sampled = recordingOf({"--policy", "blind.pack"});
  EXPECT_TRUE(recordingOf({"--policy", "blind.pack", "--sampled"}) == sampled);
  const std::string likeliest = recordingOf({"--policy", "blind.pack", "--deterministic"});
  EXPECT_FALSE(likeliest == sampled);
  const ProgramRun result = run({"--policy", "blind.pack", "--deterministic"});
  EXPECT_THAT(result.out, HasSubstr("wanderer, its likeliest actions; "));
}

TEST_F(PolicyCli, IsRecordedAndReplayedBitForBit) {
  for (const char* pack : {"blind.pack", "seeing.pack"}) {
    const ProgramRun recorded =
        run({"--policy", pack, "--backend", "soft", "--record", "run.rec", "--threads", "2"});
    ASSERT_EQ(recorded.exit_code, 0) << recorded.err;
    const ProgramRun replayed =
        runBare({"world.pack", "--policy", "replay:run.rec", "--threads", "1"});
    EXPECT_EQ(replayed.exit_code, 0) << replayed.err;
    EXPECT_THAT(replayed.out, HasSubstr("20 steps, bit for bit the same"));
  }
}

TEST_F(PolicyCli, DoesNotReplaceThePolicy) {
  const std::string before = content("blind.pack");
  for (const char* option : {"--record", "--report", "--view", "--animation"}) {
    const ProgramRun result = run({"--policy", "blind.pack", option, "./blind.pack"});
    EXPECT_EQ(result.exit_code, 3) << option;
    EXPECT_EQ(result.err, "galactic-run: ./blind.pack: is also an input; write to another file\n");
  }
  EXPECT_TRUE(content("blind.pack") == before);
}

TEST_F(PolicyCli, IsShownInPicturesOfAnotherCamera) {
  const ProgramRun result =
      run({"--policy", "seeing.pack", "--backend", "soft", "--render", "rgb", "--size", "40",
           "--camera", "follow", "--contact-sheet", "sheet.png", "--record", "shown.rec"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("drawing       rgb 40 x 40, camera follow"));
  EXPECT_TRUE(std::filesystem::exists(folder_.path() / "sheet.png"));
  EXPECT_TRUE(content("shown.rec") == recordingOf({"--policy", "seeing.pack", "--backend", "soft"}))
      << "pictures for people change nothing";
}

TEST_F(PolicyCli, SaysWhichPolicyAPackHolds) {
  const ProgramRun result = runBare({"blind.pack"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out,
              StartsWith("blind.pack: policy \"wanderer\", format 1, by galactic.export"));
}

struct Refusal {
  std::vector<std::string> arguments;
  int exit_code = 0;
  std::string message;
};

TEST_F(PolicyCli, SaysWhatDoesNotFit) {
  PolicyContent other_robot = homePolicy(false);
  other_robot.interface.robot = "fetch";
  write("fetch.pack", other_robot);
  PolicyContent laser = homePolicy(false);
  laser.interface.observation[0].name = "sonar";
  write("sonar.pack", laser);
  PolicyContent wide = homePolicy(false);
  wide.interface.observation[6].size = 3;
  wide.interface.observation[7].size = 4;
  write("wide.pack", wide);
  PolicyContent camera = homePolicy(true);
  camera.interface.image->camera = "nose";
  write("nose.pack", camera);
  static_cast<void>(folder_.write("text.pack", "no pack at all"));
  const std::vector<Refusal> refusals{
      {{"--policy", "fetch.pack"}, 3, "moves the robot \"fetch\", and the world has \"helper\""},
      {{"--policy", "sonar.pack"}, 3, "reads the observation \"sonar\", and the simulation has"},
      {{"--policy", "wide.pack"},
       3,
       "reads 3 numbers of the observation \"joints\", and the simulation has 4"},
      {{"--policy", "nose.pack", "--backend", "soft"}, 3, "found no link \"nose\" in helper"},
      {{"--policy", "blind.pack", "--depth-noise", "0.1"},
       3,
       "blind.pack: this policy sees no depth, and nobody else does, but noise or jitter of it was "
       "asked for; leave that out, or add --render"},
      {{"--policy", "blind.pack", "--light-jitter", "0.1"}, 3, "this policy sees no color, and"},
      {{"--policy", "blind.pack", "--camera-jitter", "0.1"}, 3, "this policy sees no image, and"},
      {{"--policy", "world.pack"}, 3, "is a pack of kind WRLD, expected a policy (PLCY)"},
      {{"--policy", "text.pack"}, 3, "has 14 bytes, a pack has at least 64"},
      {{"--policy", "none.pack"}, 2, "none.pack"},
      {{"--deterministic"},
       1,
       "--deterministic applies to learned policies only; add --policy FILE.pack"},
      {{"--policy", "random", "--backend", "soft"}, 1, "applies to rendering only; add --render"},
      {{"--policy", "learned"},
       1,
       "expected random, forward, zero, scripted, FILE.pack or replay"}};
  for (const Refusal& refusal : refusals) {
    const ProgramRun result = run(refusal.arguments);
    EXPECT_EQ(result.exit_code, refusal.exit_code) << refusal.message << "\n" << result.err;
    EXPECT_THAT(result.err, AllOf(StartsWith("galactic-run: "), HasSubstr(refusal.message)));
    EXPECT_THAT(result.out, Not(HasSubstr("steps each")));
  }
}

}  // namespace
}  // namespace galactic::policy_cli_test
