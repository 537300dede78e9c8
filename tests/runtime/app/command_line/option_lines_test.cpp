// Options as lines of text: what recordings keep and reports show.
#include "command_line/option_lines.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

#include "support/homes/every_option.h"

namespace galactic::option_lines_test {
namespace {

using testing::HasSubstr;

/// Every field another than its default, floats that print with many digits among them.
SimulationOptions unusualOptions() {
  SimulationOptions options;
  options.envs = 7;
  options.seed = UINT64_MAX;
  options.order = EpisodeOrder::kPartition;
  options.rank = 2;
  options.continuous_collision = true;
  options.ranks = 3;
  options.action = {
      .grasp = 0.1F, .release = -0.7F, .terminate = 1.0F / 3, .grasp_shape = GraspShape::kBox};
  options.slide = {.attempts = 5, .direction = SlideDirection::kTowardsBase, .step = 0.05F};
  options.placement = {.attempts = 2,
                       .most_lift = 0.3F,
                       .clearance = 0.1F / 7,
                       .direction_spread = 3.14159265F,
                       .jitter = 1e-8F};
  options.ground = {.most_rise = 0.2F, .most_drop = 0.4F};
  options.noise = {.motion = {0.1F / 3, 0.1F},
                   .motion_bias = 0.03F,
                   .localization = 0.2F,
                   .action_delay = {1, 3}};
  options.sensors = test::everySensor();
  options.sensors.laser.heights = {{0.1F / 3, 0.1F / 3}, {1e-6F, 0.8F}};
  options.task = test::everyReward();
  options.task.kind = TaskKind::kMobilePick;
  options.task.action_weight = 1e-5F;
  options.task.needs_terminate = false;
  options.task.terminate_after = 5;
  options.task.drop_fails = false;
  options.task.distractors = false;
  return options;
}

TEST(OptionText, ReadsBackWhatItWrote) {
  const SimulationOptions options = unusualOptions();
  const std::string lines = optionLines(options);
  const Result<SimulationOptions> read = parseOptionLines(lines, "file");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(optionLines(*read), lines);
  EXPECT_EQ(read->seed, UINT64_MAX);
  EXPECT_EQ(read->action.terminate, options.action.terminate);
  EXPECT_EQ(read->placement.clearance, options.placement.clearance);
  EXPECT_EQ(read->placement.jitter, options.placement.jitter);
  EXPECT_EQ(read->sensors.laser.heights, options.sensors.laser.heights);
  EXPECT_EQ(read->noise.motion, options.noise.motion);
  EXPECT_EQ(read->noise.action_delay, options.noise.action_delay);
  EXPECT_EQ(read->task.kind, TaskKind::kMobilePick);
  EXPECT_FALSE(read->task.distractors);
}

TEST(OptionText, NamesEveryOptionOnceAndWritesEveryField) {
  const std::vector<OptionText> plain = listOptions({});
  const std::vector<OptionText> unusual = listOptions(unusualOptions());
  ASSERT_EQ(plain.size(), unusual.size());
  std::set<std::string> names;
  for (std::size_t n = 0; n < plain.size(); ++n) {
    EXPECT_TRUE(names.insert(plain[n].name).second) << plain[n].name;
    EXPECT_NE(plain[n].value, unusual[n].value)
        << plain[n].name << " has its default: give it another value above or, where it is one of "
        << "a sensor or of the reward, in tests/support/homes/every_option.h";
  }
}

TEST(OptionText, KeepsDefaultsOfWhatIsNotNamed) {
  const Result<SimulationOptions> read = parseOptionLines("task=none\nenvs=3\n", "file");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->envs, 3U);
  EXPECT_EQ(read->task.kind, TaskKind::kNone);
  EXPECT_EQ(read->task.most_steps, TaskOptions().most_steps);
}

TEST(OptionText, RefusesWhatMakesNoSense) {
  const std::vector<std::pair<std::string, std::string>> mistakes{
      {"envs=0\n", "envs is \"0\", expected 1 to"},
      {"envs=-1\n", "envs is \"-1\""},
      {"envs=1x\n", "envs is \"1x\""},
      {"envs=\n", "envs is \"\""},
      {"task=fly\n", "task is \"fly\", expected rearrange, pick or none"},
      {"no-terminate=yes\n", "no-terminate is \"yes\", expected true or false"},
      {"slide-step=nan\n", "slide-step is \"nan\""},
      {"slide-step=inf\n", "slide-step is \"inf\""},
      {"motion-noise=0.5-0.2\n", "motion-noise is \"0.5-0.2\", expected 0 to 1, or a range"},
      {"laser-noise=-1-0.2\n", "laser-noise is \"-1-0.2\", expected -1 to 10, or a range from 0"},
      {"envs=1\nenvs=1\n", "each name once"},
      {"envs=1", "lines name=value"},
      {"envs\n", "lines name=value"},
      {"\n", "lines name=value"},
  };
  for (const auto& [lines, message] : mistakes) {
    const Result<SimulationOptions> read = parseOptionLines(lines, "file");
    ASSERT_FALSE(read) << lines;
    EXPECT_EQ(read.error().code, ErrorCode::kInvalidInput);
    EXPECT_EQ(read.error().where, "file: options");
    EXPECT_THAT(read.error().message, HasSubstr(message));
  }
  const Result<SimulationOptions> later = parseOptionLines("wings=2\n", "file");
  ASSERT_FALSE(later);
  EXPECT_EQ(later.error().code, ErrorCode::kUnsupported);
  EXPECT_THAT(later.error().message, HasSubstr("wings"));
}

TEST(OptionText, FindsTheFirstDifference) {
  SimulationOptions other;
  EXPECT_FALSE(firstDifference({}, other));
  other.ground.most_drop = 0.25F;
  const auto difference = firstDifference(other, {});
  ASSERT_TRUE(difference);
  EXPECT_EQ(difference->name, "floor-drop");
  EXPECT_EQ(difference->value, "0.25");
}

}  // namespace
}  // namespace galactic::option_lines_test
