// The command line of galactic-run, as far as it needs no program.
#include "command_line/options.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <regex>
#include <string>
#include <vector>

#include "galactic/error.h"

namespace galactic::options_test {
namespace {

std::optional<int> parse(std::vector<std::string> arguments, RunOptions& options) {
  arguments.insert(arguments.begin(), {"galactic-run", "world.pack"});
  std::vector<const char*> argv;
  argv.reserve(arguments.size());
  for (const std::string& argument : arguments) argv.push_back(argument.c_str());
  return parseCommandLine(static_cast<int>(argv.size()), argv.data(), options);
}

RunOptions parsed(const std::vector<std::string>& arguments) {
  RunOptions options;
  EXPECT_EQ(parse(arguments, options), std::nullopt);
  return options;
}

TEST(RunCommandLine, SimulatesWhenAnOptionOfTheSimulationIsTyped) {
  EXPECT_FALSE(parsed({}).simulates);
  EXPECT_FALSE(parsed({"--bench", "--seed", "5", "--trusted"}).simulates);
  EXPECT_FALSE(parsed({"--bench"}).simulates);
  for (const char* option : {"--no-distractors", "--safe-drop", "--body-transforms"}) {
    EXPECT_TRUE(parsed({option}).simulates) << option;
  }
  EXPECT_TRUE(parsed({"--steps", "5"}).simulates);
  EXPECT_TRUE(parsed({"--slide", "off"}).simulates);
  EXPECT_TRUE(parsed({"--reach-weight", "2"}).simulates);
}

TEST(RunCommandLine, TakesPacksWithAndWithoutTheOptionsName) {
  using Packs = std::vector<std::string>;
  EXPECT_EQ(parsed({}).packs, (Packs{"world.pack"}));
  EXPECT_EQ(parsed({"robot.pack"}).packs, (Packs{"world.pack", "robot.pack"}));
  EXPECT_EQ(parsed({"--pack", "robot.pack", "--bench"}).packs, (Packs{"world.pack", "robot.pack"}));
}

/// The options of --help whose values are numbers.
std::vector<std::string> numberOptions() {
  testing::internal::CaptureStdout();
  RunOptions options;
  EXPECT_EQ(parse({"--help"}, options), 0);
  std::fflush(stdout);
  const std::string help = testing::internal::GetCapturedStdout();
  std::vector<std::string> names;
  const std::regex option(R"((--[a-z-]+) (?:N|NUMBER|DEGREES|N\|WxH)[ \n])");
  for (std::sregex_iterator at(help.begin(), help.end(), option), end; at != end; ++at) {
    names.push_back((*at)[1]);
  }
  return names;
}

TEST(RunCommandLine, RefusesWhatIsNoNumber) {
  const std::vector<std::string> names = numberOptions();
  EXPECT_GT(names.size(), 30U);
  for (const std::string& name : names) {
    for (const char* value : {"nan", "-nan", "inf", "-inf", "1e999", "abc", "", " ", "1,2", "1 ",
                              "0x10", "99999999999999999999999", "--1", "+1"}) {
      RunOptions options;
      testing::internal::CaptureStderr();
      EXPECT_EQ(parse({"--render", "rgb", "--frames", "dir", "--debug-view", name + "=" + value},
                      options),
                kExitUsage)
          << name << "=" << value;
      EXPECT_EQ(testing::internal::GetCapturedStderr().find("galactic-run: command line: "), 0U);
    }
  }
}

TEST(RunCommandLine, RefusesNegativeAndOctalWholeNumbers) {
  for (const char* name : {"--seed", "--steps", "--threads", "--envs", "--rank", "--ranks",
                           "--frame-every", "--frame-envs", "--episode-steps"}) {
    for (const char* value : {"-1", "010", "1.5", "1e2"}) {
      RunOptions options;
      testing::internal::CaptureStderr();
      EXPECT_EQ(
          parse({"--render", "rgb", "--frames", "dir", std::string(name) + "=" + value}, options),
          kExitUsage)
          << name << "=" << value;
      (void)testing::internal::GetCapturedStderr();
    }
  }
}

TEST(RunCommandLine, RefusesADeviceThatNothingUsesAndSuggestsNames) {
  RunOptions options;
  testing::internal::CaptureStderr();
  EXPECT_EQ(parse({"--render", "rgb", "--backend", "soft", "--device", "0"}, options), kExitUsage);
  EXPECT_EQ(parse({"--env", "3"}, options), kExitUsage);
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_NE(said.find("--device applies to --backend cuda and gl"), std::string::npos) << said;
  EXPECT_NE(said.find("did you mean '--envs'"), std::string::npos) << said;
}

TEST(RunCommandLine, FindsWhatHasNoEffect) {
  const auto without_effect = [](const std::vector<std::string>& arguments) {
    return parsed(arguments).without_effect;
  };
  for (const char* option :
       {"--laser-fov", "--laser-heights", "--laser-range", "--laser-min-range", "--laser-noise"}) {
    EXPECT_EQ(without_effect({option, "1"}),
              std::string(option) + " applies to a laser scan only; add --laser-beams N");
    EXPECT_NE(without_effect({option, "1", "--laser-beams", "0"}), "") << option;
    EXPECT_EQ(without_effect({option, "1", "--laser-beams", "8"}), "") << option;
  }
  EXPECT_EQ(without_effect({"--laser-beams", "0"}), "");
  EXPECT_EQ(without_effect({"--geodesic-megabytes", "5"}),
            "--geodesic-megabytes applies to paths along the floor only; add --geodesic or "
            "--geodesic-weight X");
  EXPECT_EQ(without_effect({"--geodesic-megabytes", "5", "--geodesic"}), "");
  EXPECT_EQ(without_effect({"--geodesic-megabytes", "5", "--geodesic-weight", "0.5"}), "");
  EXPECT_EQ(without_effect({"--terminate-after", "5", "--task", "rearrange"}), "");
  EXPECT_NE(without_effect({"--terminate-after", "5", "--task", "pick"}), "");
  EXPECT_NE(without_effect({"--terminate-after", "5", "--no-terminate"}), "");
  for (const char* off : {"--slide=off", "--slide-attempts=0"}) {
    EXPECT_EQ(without_effect({off}), "") << off;
    EXPECT_EQ(without_effect({off, "--slide-step", "0.1"}),
              "--slide-step applies to robots that slide, and sliding is off; leave it out");
  }
  EXPECT_EQ(without_effect({"--slide", "off", "--slide-attempts", "2", "--slide-step", "1"}), "");
  EXPECT_NE(without_effect({"--place-attempts", "0", "--place-lift", "1"}), "");
  EXPECT_EQ(without_effect({"--place-attempts", "1", "--place-lift", "1"}), "");
  EXPECT_EQ(without_effect({"--task", "none", "--success-reward", "5"}),
            "--success-reward applies to the reward of a task, and --task is none; leave it out");
  EXPECT_EQ(without_effect({"--success-reward", "5"}), "");
  EXPECT_EQ(without_effect({"--task", "none", "--episode-steps", "5"}), "");
}

TEST(RunCommandLine, DoesNotJudgeWhatIsNotTyped) {
  // As a world or a recording says.
  RunOptions options;
  options.simulation.sensors.laser.fov_degrees = 90;
  options.simulation.task.kind = TaskKind::kNone;
  options.simulation.task.success_reward = 5;
  ASSERT_EQ(parse({"--steps", "5"}, options), std::nullopt);
  EXPECT_EQ(options.without_effect, "");
  options.simulation.sensors.laser.beams = 8;
  ASSERT_EQ(parse({"--laser-range", "5"}, options), std::nullopt);
  EXPECT_EQ(options.without_effect, "");
}

/// What is said when the command line is refused.
std::string refusalOf(const std::vector<std::string>& arguments) {
  RunOptions options;
  testing::internal::CaptureStderr();
  EXPECT_EQ(parse(arguments, options), kExitUsage) << testing::PrintToString(arguments);
  return testing::internal::GetCapturedStderr();
}

TEST(RunCommandLine, SaysWhatToDoWithACheckpoint) {
  EXPECT_EQ(refusalOf({"--policy", "runs/pick/best.pt"}),
            "galactic-run: command line: --policy: unknown policy runs/pick/best.pt, expected "
            "random, forward, zero, scripted, FILE.pack or replay:FILE; python3 -m galactic.export "
            "makes a policy pack of it; see --help\n");
  EXPECT_EQ(refusalOf({"--policy", "dance"}).find("galactic.export"), std::string::npos);
}

TEST(RunCommandLine, SamplesOrTakesTheLikeliest) {
  EXPECT_TRUE(parsed({"--policy", "a.pack", "--deterministic"}).is_deterministic);
  EXPECT_FALSE(parsed({"--policy", "a.pack", "--sampled"}).is_deterministic);
  EXPECT_FALSE(parsed({"--policy", "a.pack"}).is_deterministic);
  EXPECT_NE(refusalOf({"--policy", "a.pack", "--deterministic", "--sampled"}).find("excludes"),
            std::string::npos);
}

TEST(RunCommandLine, RefusesDetailsOfWhatIsNotAskedFor) {
  const auto refused = [](const std::vector<std::string>& arguments, const char* why) {
    EXPECT_NE(refusalOf(arguments).find(why), std::string::npos) << refusalOf(arguments);
  };
  refused({"--seed", "5"}, "--seed applies to simulations and --bench only");
  refused({"--sampled", "--steps", "5"}, "--sampled applies to learned policies only");
  refused({"--view-envs", "5"}, "--view-envs applies to the page of a run only");
}

TEST(RunCommandLine, HelpIsFreeOfTheParsersNotation) {
  RunOptions options;
  testing::internal::CaptureStdout();
  EXPECT_EQ(parse({"--help"}, options), 0);
  std::fflush(stdout);
  const std::string help = testing::internal::GetCapturedStdout();
  EXPECT_EQ(help.find('{'), std::string::npos) << help;
  EXPECT_EQ(help.find("Excludes"), std::string::npos) << help;
  EXPECT_NE(help.find("\n  --deterministic  "), std::string::npos) << help;
  EXPECT_NE(help.find("\n  --sampled  "), std::string::npos) << help;
}

TEST(RunCommandLine, HasUsefulDefaults) {
  const RunOptions options = parsed({"--steps", "5"});
  EXPECT_EQ(options.simulation.envs, 1024U);
  EXPECT_EQ(options.policy, "random");
  EXPECT_EQ(options.simulation.task.kind, TaskKind::kRearrange);
  EXPECT_EQ(options.replayFile(), "");
}

TEST(RunCommandLine, SlidesByNameAndInDetail) {
  const SlideOptions published = parsed({"--slide", "published"}).simulation.slide;
  EXPECT_EQ(published.direction, SlideDirection::kTowardsBase);
  EXPECT_EQ(published.attempts, 5U);
  EXPECT_EQ(published.step, 0.05F);
  EXPECT_EQ(parsed({"--slide", "off"}).simulation.slide.attempts, 0U);
  // In any order, the details refine the name.
  const SlideOptions mixed =
      parsed({"--slide-attempts", "2", "--slide", "published"}).simulation.slide;
  EXPECT_EQ(mixed.direction, SlideDirection::kTowardsBase);
  EXPECT_EQ(mixed.attempts, 2U);
}

TEST(RunCommandLine, KeepsWhatIsNotTyped) {
  RunOptions options;
  options.simulation.task.needs_terminate = false;
  options.simulation.task.kind = TaskKind::kMobilePick;
  options.simulation.slide.attempts = 1;
  EXPECT_EQ(parse({"--policy", "replay:a:b", "--threads", "3"}, options), std::nullopt);
  EXPECT_FALSE(options.simulation.task.needs_terminate);
  EXPECT_EQ(options.simulation.task.kind, TaskKind::kMobilePick);
  EXPECT_EQ(options.simulation.slide.attempts, 1U);
  EXPECT_EQ(options.simulation.threads, 3U);
  EXPECT_EQ(options.replayFile(), "a:b");
}

TEST(RunCommandLine, SwitchesOffWhatAWorldHasSwitchedOn) {
  RunOptions options;
  options.simulation.task.drop_fails = false;
  options.simulation.task.observes_current_target = true;
  EXPECT_EQ(
      parse({"--safe-drop=false", "--observe-current=false", "--no-distractors=true"}, options),
      std::nullopt);
  EXPECT_TRUE(options.simulation.task.drop_fails);
  EXPECT_FALSE(options.simulation.task.observes_current_target);
  EXPECT_FALSE(options.simulation.task.distractors);
}

TEST(RunCommandLine, DrawsWhenTold) {
  EXPECT_FALSE(parsed({"--steps", "5"}).drawing.draws());
  const RunOptions plain = parsed({"--render", "rgbd"});
  EXPECT_TRUE(plain.simulates);
  EXPECT_TRUE(plain.simulation.body_transforms);
  EXPECT_TRUE(plain.drawing.hasColor() && plain.drawing.hasDepth());
  EXPECT_FALSE(plain.drawing.hasSemantics() || plain.drawing.makesPictures());
  EXPECT_EQ(plain.drawing.width, 128U);
  const DrawingOptions all = parsed({"--render",
                                     "depth",
                                     "--size",
                                     "160x96",
                                     "--backend",
                                     "soft",
                                     "--camera",
                                     "top",
                                     "--fov",
                                     "75.5",
                                     "--contact-sheet",
                                     "a.png",
                                     "--debug-view",
                                     "--debug-radius",
                                     "0.05",
                                     "--near",
                                     "0.2",
                                     "--camera-position",
                                     "-0.1,0,0.2",
                                     "--camera-rpy=0,-20,90",
                                     "--depth-noise",
                                     "0.01",
                                     "--depth-dropout",
                                     "0.02",
                                     "--camera-jitter",
                                     "0.03",
                                     "--camera-jitter-degrees",
                                     "4"})
                                 .drawing;
  EXPECT_FALSE(all.hasColor());
  EXPECT_TRUE(all.hasDepth() && all.makesPictures());
  EXPECT_EQ(all.width, 160U);
  EXPECT_EQ(all.height, 96U);
  EXPECT_EQ(all.backend, RenderBackend::kSoft);
  EXPECT_EQ(all.fov_degrees, 75.5F);
  EXPECT_EQ(all.debug_radius, 0.05F);
  EXPECT_EQ(all.near, 0.2F);
  EXPECT_EQ(all.camera_position, (std::array{-0.1F, 0.0F, 0.2F}));
  EXPECT_EQ(all.camera_rpy_degrees, (std::array{0.0F, -20.0F, 90.0F}));
  EXPECT_TRUE(all.isNoisy());
  EXPECT_EQ(all.noise.depth_noise, 0.01F);
  EXPECT_EQ(all.noise.depth_dropout, 0.02F);
  EXPECT_EQ(all.jitter.camera_jitter, 0.03F);
  EXPECT_EQ(all.jitter.camera_jitter_degrees, 4);
  const DrawingOptions color =
      parsed({"--render", "rgb", "--size", "64", "--color-noise", "5", "--light-jitter", "0.3"})
          .drawing;
  EXPECT_EQ(color.height, 64U);
  EXPECT_EQ(color.noise.color_noise, 5);
  EXPECT_EQ(color.noise.light_jitter, 0.3F);
  const DrawingOptions drawn = parsed({"--render", "rgbd", "--depth-noise", "0.01-0.03",
                                       "--camera-jitter", "0-0.05", "--camera-jitter-fov", "3"})
                                   .drawing;
  EXPECT_EQ(drawn.noise.depth_noise, DrawnNumber(0.01F, 0.03F));
  EXPECT_EQ(drawn.jitter.camera_jitter, DrawnNumber(0, 0.05F));
  EXPECT_EQ(drawn.jitter.camera_jitter_fov, DrawnNumber(3));
  EXPECT_TRUE(drawn.isNoisy());
  EXPECT_FALSE(plain.drawing.isNoisy());
  // What a policy sees may be noisy where nothing else is drawn.
  EXPECT_TRUE(parsed({"--policy", "eyes.pack", "--depth-noise", "0.1", "--camera-jitter", "0.1"})
                  .drawing.isNoisy());
}

TEST(RunCommandLine, RefusesWhatMakesNoSense) {
  const std::vector<std::vector<std::string>> mistakes{
      {"--render", "color"},
      {"--render", "rgb", "--size", "0"},
      {"--render", "rgb", "--size", "128x"},
      {"--render", "rgb", "--size", "12x5000"},
      {"--render", "rgb", "--size", "12x12x12"},
      {"--render", "rgb", "--fov", "180"},
      {"--render", "rgb", "--backend", "vulkan"},
      {"--render", "rgb", "--near", "0"},
      {"--render", "rgb", "--camera-position", "1,2"},
      {"--render", "rgb", "--camera-position", "1,2,x"},
      {"--render", "rgb", "--camera-position", "1,2,3,4"},
      {"--render", "rgb", "--camera-rpy", "0,0,361"},
      {"--camera-rpy", "0,0,90"},
      {"--action-delay", "-1"},
      {"--action-delay", "0.5"},
      {"--action-delay", "101"},
      {"--action-delay", "3-1"},
      {"--action-delay", "0-1000000000000"},
      {"--render", "depth", "--depth-noise", "1.1"},
      {"--render", "depth", "--depth-noise", "nan"},
      {"--render", "depth", "--depth-dropout", "-0.1"},
      {"--render", "depth", "--depth-noise", "0.3-0.1"},
      {"--render", "depth", "--depth-noise", "0.3-1.1"},
      {"--render", "depth", "--depth-noise", "0.1-"},
      {"--render", "depth", "--depth-noise", "0.1-0.2-0.3"},
      {"--render", "rgb", "--color-noise", "256"},
      {"--render", "rgb", "--light-jitter", "2"},
      {"--render", "rgb", "--camera-jitter", "1.1"},
      {"--render", "rgb", "--camera-jitter-degrees", "181"},
      {"--render", "rgb", "--camera-jitter-fov", "91"},
      {"--render", "rgb", "--depth-noise", "0.1"},
      {"--render", "rgb", "--depth-dropout", "0.1"},
      {"--render", "rgb", "--depth-dropout", "0-0.1"},
      {"--render", "depth", "--color-noise", "3"},
      {"--render", "depth", "--light-jitter", "0.1"},
      {"--depth-noise", "0.1"},
      {"--camera-jitter", "0.1"},
      {"--policy", "eyes.pack", "--fov", "70"},
      {"--render", "rgb", "--debug-view"},
      {"--render", "rgb", "--frame-every", "5"},
      {"--render", "rgb", "--frames", "f", "--debug-camera", "top"},
      {"--size", "64"},
      {"--frames", "f"},
      {"--debug-view"},
      {"--policy", "dance"},
      {"--policy", "replay:"},
      {"--policy", ""},
      {"--envs", "0"},
      {"--envs", "-1"},
      {"--envs", "1.5"},
      {"--envs", "9999999999"},
      {"--steps", "0"},
      {"--steps", "many"},
      {"--task", "fly"},
      {"--task", ""},
      {"--order", "random"},
      {"--slide", "up"},
      {"--slide-step", "nan"},
      {"--slide-step", "-1"},
      {"--slide-step", "inf"},
      {"--success-distance", "1e9"},
      {"--success-distance", "0x1"},
      {"--threads", "-1"},
      {"--safe-drop=maybe"},
      {"--safe-drop=2"},
      {"--rank", "1"},
      {"--rank", "2", "--ranks", "2"},
      {"--bench", "--steps", "5"},
      {"--bench", "--seed", "4294967296"},
      {"--pack"},
  };
  for (const std::vector<std::string>& arguments : mistakes) {
    RunOptions options;
    EXPECT_EQ(parse(arguments, options), kExitUsage) << testing::PrintToString(arguments);
  }
}

}  // namespace
}  // namespace galactic::options_test
