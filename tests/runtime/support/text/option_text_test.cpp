// Options as texts: every one of them is written, read back, and refused outside its range.
#include "galactic/option_text.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "support/option_table.h"

namespace galactic::option_text_test {
namespace {

TEST(OptionTexts, OfATaskAreThoseOfARunWithoutTheBatch) {
  const std::vector<OptionText> all = listOptions({});
  const std::vector<OptionText> task = listOptions({}, OptionScope::kTask);
  ASSERT_GT(task.size(), 20U);
  ASSERT_LT(task.size(), all.size());
  for (std::size_t n = 0; n < task.size(); ++n) {
    EXPECT_EQ(task[n], all[all.size() - task.size() + n]);
  }
  EXPECT_EQ(all.front().name, "envs");
  EXPECT_EQ(task.front(), (OptionText{"task", "rearrange", true}));
}

TEST(OptionTexts, AreSetInAnyOrderAndLeaveTheRest) {
  SimulationOptions options;
  options.envs = 5;
  const std::vector<OptionText> texts{
      {"slide-step", "0.25"}, {"safe-drop", "true"}, {"episode-steps", "7"}, {"task", "none"}};
  EXPECT_FALSE(setOptions(texts, OptionScope::kTask, options));
  SimulationOptions wanted;
  wanted.envs = 5;
  wanted.slide.step = 0.25F;
  wanted.task.drop_fails = false;
  wanted.task.most_steps = 7;
  wanted.task.kind = TaskKind::kNone;
  EXPECT_EQ(listOptions(options), listOptions(wanted));
  EXPECT_FALSE(setOptions(listOptions(SimulationOptions()), OptionScope::kAll, options));
  EXPECT_EQ(listOptions(options), listOptions({}));
}

TEST(OptionTexts, TellWhichOfThemIsAtFault) {
  const auto faultOf = [](std::vector<OptionText> texts, OptionScope scope) {
    SimulationOptions ignored;
    const auto fault = setOptions(texts, scope, ignored);
    return fault ? fmt::format("{}: {}", fault->index, fault->wanted) : std::string("none");
  };
  constexpr OptionScope kTask = OptionScope::kTask;
  EXPECT_EQ(faultOf({{"safe-drop", "true"}, {"episode-steps", "x"}}, kTask), "1: 0 to 1073741824");
  EXPECT_EQ(faultOf({{"safe-drop", "TRUE"}}, kTask), "0: true or false");
  EXPECT_EQ(faultOf({{"task", "fly"}}, kTask), "0: rearrange, pick or none");
  EXPECT_EQ(faultOf({{"safe-drop", "true"}, {"wings", "2"}}, kTask), "1: ");
  EXPECT_EQ(faultOf({{"safe-drop", "true"}, {"safe-drop", "true"}}, kTask), "1: ");
  EXPECT_EQ(faultOf({{"envs", "5"}}, kTask), "0: ");
  EXPECT_EQ(faultOf({{"envs", "5"}}, OptionScope::kAll), "none");
  EXPECT_EQ(faultOf({{"slide", "off"}}, OptionScope::kAll), "0: ");
  EXPECT_EQ(faultOf({{"slide", "of"}}, OptionScope::kTyped), "0: glide, published or off");
}

TEST(OptionTexts, ThatSomebodyTypesMayBePresetsWhichTheirPartsRefine) {
  SimulationOptions options;
  const std::vector<OptionText> texts{{"slide-step", "0.25"}, {"slide", "published"}};
  EXPECT_FALSE(setOptions(texts, OptionScope::kTyped, options));
  EXPECT_EQ(options.slide.direction, SlideDirection::kTowardsBase);
  EXPECT_EQ(options.slide.attempts, 5U);
  EXPECT_EQ(options.slide.step, 0.25F);
}

TEST(OptionTexts, TellWhatEpisodesMayDraw) {
  EXPECT_EQ(drawnOptionNames(),
            (std::vector<std::string>{"motion-noise", "motion-bias", "localization-noise",
                                      "action-delay", "laser-noise"}));
  SimulationOptions options;
  const std::vector<OptionText> texts{{"motion-noise", "0.2-0.8"}, {"motion-bias", "0.1"}};
  EXPECT_FALSE(setOptions(texts, OptionScope::kTask, options));
  EXPECT_EQ(options.noise.motion, DrawnNumber(0.2F, 0.8F));
  EXPECT_EQ(options.noise.motion_bias, DrawnNumber(0.1F));
  for (const OptionText& listed : listOptions(options)) {
    // JSON has numbers for numbers.
    if (listed.name == "motion-noise") {
      EXPECT_EQ(listed, (OptionText{"motion-noise", "0.2-0.8", true}));
    }
    if (listed.name == "motion-bias") {
      EXPECT_EQ(listed, (OptionText{"motion-bias", "0.1", false}));
    }
  }
}

TEST(OptionTexts, HaveTheNamesOfTheTable) {
  std::vector<std::string> listed;
  for (const OptionText& option : listOptions({})) listed.push_back(option.name);
  EXPECT_EQ(optionNames(OptionScope::kAll), listed);
  const std::vector<std::string> typed = optionNames(OptionScope::kTyped);
  EXPECT_EQ(typed.size(), listed.size() + 1);
  EXPECT_NE(std::find(typed.begin(), typed.end(), "slide"), typed.end());
}

TEST(OptionTexts, TellWhichAreNoiseOfTheRobot) {
  EXPECT_EQ(optionNames(OptionScope::kRobotNoise),
            (std::vector<std::string>{"motion-noise", "motion-bias", "localization-noise",
                                      "action-delay"}));
  SimulationOptions options;
  options.noise.motion = 0.5F;
  const std::vector<OptionText> listed = listOptions(options, OptionScope::kRobotNoise);
  ASSERT_EQ(listed.size(), 4U);
  EXPECT_EQ(listed[0], (OptionText{"motion-noise", "0.5", false}));
  const std::vector<OptionText> laser{{"laser-noise", "0.1"}};
  EXPECT_TRUE(setOptions(laser, OptionScope::kRobotNoise, options));
}

/// Numbers about the ends of the range of an option of the table, and whether it should take them:
/// the answer comes from the numbers, before they are text.
class RangeProbe {
 public:
  void group(std::string_view) {}
  void whole(std::string_view name, std::uint32_t&, Within<std::uint32_t> within,
             std::string_view) {
    const std::int64_t least = within.least;
    const std::int64_t most = within.most;
    std::uniform_int_distribution<std::int64_t> about(least - (most - least) / 2 - 1,
                                                      most + (most - least) / 2 + 1);
    for (int n = 0; n < kDraws; ++n) {
      const std::int64_t value = about(engine_);
      probe(name, fmt::format("{}", value), value >= least && value <= most);
    }
    probe(name, fmt::format("{}", least), true);
    probe(name, fmt::format("{}", most), true);
    probe(name, fmt::format("{}", most + 1), false);
    probe(name, fmt::format("{}", least - 1), false);
  }
  void seed(std::string_view, std::uint64_t&, std::string_view) {}
  void real(std::string_view name, float&, Within<float> within, std::string_view) {
    const double least = static_cast<double>(within.least);
    const double most = static_cast<double>(within.most);
    std::uniform_real_distribution<double> about(1.5 * least - 0.5 * most,
                                                 1.5 * most - 0.5 * least);
    for (int n = 0; n < kDraws; ++n) {
      const auto value = static_cast<float>(about(engine_));
      probe(name, fmt::format("{}", value), value >= within.least && value <= within.most);
    }
    probe(name, fmt::format("{}", within.least), true);
    probe(name, fmt::format("{}", within.most), true);
  }
  void drawn(std::string_view name, DrawnNumber&, const Span& within, std::string_view) {
    const std::string least = fmt::format("{}", within.lo);
    const std::string most = fmt::format("{}", within.hi);
    for (const std::string& good : {least, most, "0-" + most, std::string("0.25-0.5")}) {
      probe(name, good, true);
    }
    for (const std::string& wrong :
         {most + ".5", "0-" + most + ".5", "-" + most + "-0.5", std::string("0.5-0.25"),
          std::string("0-nan"), std::string("nan"), std::string("0.1-0.2-0.3")}) {
      probe(name, wrong, false);
    }
  }
  void drawn(std::string_view name, DrawnCount&, std::uint32_t most, std::string_view) {
    for (const std::string& good : {std::string("0"), fmt::format("{}", most), std::string("1-3"),
                                    fmt::format("0-{}", most)}) {
      probe(name, good, true);
    }
    for (const std::string& wrong :
         {fmt::format("{}", most + 1), fmt::format("0-{}", most + 1), std::string("-1"),
          std::string("3-1"), std::string("0.5"), std::string("0-1-2")}) {
      probe(name, wrong, false);
    }
  }
  void heights(std::string_view name, std::vector<Span>&, const Span& within, std::string_view) {
    const std::string most = fmt::format("{}", within.hi);
    for (const std::string& good : {std::string("robot"), "0-" + most, "0," + most + ",0.5-1.5"}) {
      probe(name, good, true);
    }
    for (const std::string& wrong : {most + ".5", "1-" + most + "1", std::string("1-0.5")}) {
      probe(name, wrong, false);
    }
  }
  void flag(std::string_view, const Switch&, std::string_view) {}
  template <class T, std::size_t N>
  void choice(std::string_view name, T&, const std::array<Named<T>, N>& names, std::string_view) {
    for (const Named<T>& one : names) {
      probe(name, std::string(one.name), true);
      probe(name, std::string(one.name) + "s", false);
    }
  }
  template <class T>
  void preset(std::string_view, const T&, const Preset<T>&, std::string_view) {}

  [[nodiscard]] double acceptedShare() const {
    return static_cast<double>(accepted_) / static_cast<double>(probes_);
  }

 private:
  static constexpr int kDraws = 40;

  void probe(std::string_view name, const std::string& value, bool is_good) {
    const OptionText text{std::string(name), value};
    SimulationOptions options;
    const auto fault = setOptions(std::span(&text, 1), OptionScope::kTask, options);
    EXPECT_EQ(!fault, is_good) << name << " = " << value;
    EXPECT_TRUE(checkOptions(options)) << name << " = " << value;
    ++probes_;
    accepted_ += fault ? 0U : 1U;
    if (fault) return;
    // What was read is what is written: the same number.
    for (const OptionText& written : listOptions(options, OptionScope::kTask)) {
      if (written.name == name) {
        EXPECT_EQ(written.value, value);
      }
    }
  }

  std::mt19937 engine_{20260};
  std::size_t probes_ = 0;
  std::size_t accepted_ = 0;
};

TEST(OptionTexts, AreTakenWithinTheirRangeAndNotOutside) {
  SimulationOptions options;
  RangeProbe probe;
  visitWorldTask(options, probe);
  EXPECT_GT(probe.acceptedShare(), 0.1);
  EXPECT_LT(probe.acceptedShare(), 0.9);
}

/// Gives the fields of `options`, one after the other, values just out of their ranges.
class FieldProbe {
 public:
  explicit FieldProbe(SimulationOptions& options) : options_(options) {}

  void group(std::string_view) {}
  void seed(std::string_view, std::uint64_t&, std::string_view) {}
  void flag(std::string_view, const Switch&, std::string_view) {}
  void drawn(std::string_view name, DrawnNumber& field, const Span& within, std::string_view) {
    for (const DrawnNumber& wrong :
         {DrawnNumber(within.lo - 1), DrawnNumber(within.hi + 1), DrawnNumber(std::nanf("")),
          DrawnNumber(0, within.hi + 1), DrawnNumber(-0.5F, within.hi),
          DrawnNumber(within.hi, within.lo), DrawnNumber(0, std::nanf(""))}) {
      probe(name, field, wrong);
    }
  }
  void drawn(std::string_view name, DrawnCount& field, std::uint32_t most, std::string_view) {
    for (const DrawnCount& wrong :
         {DrawnCount(most + 1), DrawnCount(0, most + 1), DrawnCount(most, 0)}) {
      probe(name, field, wrong);
    }
  }
  void heights(std::string_view name, std::vector<Span>& field, const Span& within,
               std::string_view) {
    for (const Span& wrong : {Span{within.lo, within.hi + 1}, Span{within.lo - 1, within.hi},
                              Span{within.hi, within.lo}, Span{within.lo, std::nanf("")}}) {
      probe(name, field, std::vector<Span>{wrong});
    }
    probe(name, field, std::vector<Span>(kMostLaserHeights + 1, within));
  }
  void whole(std::string_view name, std::uint32_t& field, Within<std::uint32_t> within,
             std::string_view) {
    probe(name, field, within.most + 1);
    if (within.least > 0) probe(name, field, within.least - 1);
  }
  void real(std::string_view name, float& field, Within<float> within, std::string_view) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    for (const float wrong : {std::nextafter(within.least, -kInfinity),
                              std::nextafter(within.most, kInfinity), kInfinity, std::nanf("")}) {
      probe(name, field, wrong);
    }
  }
  template <class T, std::size_t N>
  void choice(std::string_view name, T& field, const std::array<Named<T>, N>&, std::string_view) {
    probe(name, field, T{N});
  }
  template <class T>
  void preset(std::string_view, const T&, const Preset<T>&, std::string_view) {}

 private:
  template <class T>
  void probe(std::string_view name, T& field, T wrong) {
    const T right = std::exchange(field, wrong);
    const Result<void> checked = checkOptions(options_);
    field = right;
    ASSERT_FALSE(checked) << name;
    EXPECT_EQ(checked.error().code, ErrorCode::kInvalidInput);
    EXPECT_EQ(checked.error().message.find(fmt::format("{} is ", name)), 0U)
        << checked.error().message;
    EXPECT_TRUE(checkOptions(options_)) << name;
  }

  SimulationOptions& options_;
};

TEST(Options, AreRefusedOutsideTheirRange) {
  SimulationOptions options;
  FieldProbe probe(options);
  visitOptions(options, probe);
}

}  // namespace
}  // namespace galactic::option_text_test
