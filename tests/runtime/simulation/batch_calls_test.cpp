// Calls that do not keep to what the simulator asks for.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "batch_trace.h"

namespace galactic::test::batch_calls_test {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr std::uint32_t kEnvs = 20;

/// A call that is refused, and after it the batch is as it was.
template <class Call>
void expectRefused(const BatchSimulator& simulator, const Call& call, const std::string& message) {
  const std::vector<std::byte> before = simulator.saveState();
  EXPECT_THAT(call, ThrowsMessage<ErrorException>(HasSubstr(message)));
  EXPECT_EQ(simulator.saveState(), before);
}

class BatchCalls : public testing::Test {
 protected:
  void SetUp() override {
    actions_.resize(kEnvs * simulator_.actionCount());
    simulator_.step(actions_);
  }

  BoxWorld world_ = furnishedWorld();
  BatchSimulator simulator_ = BatchSimulator::create(world_.world(), optionsFor(kEnvs, 2)).value();
  std::vector<float> actions_;
};

TEST_F(BatchCalls, WithArraysOfOtherLengthsAreRefused) {
  const std::vector<float> few(5);
  const std::vector<std::int32_t> three(3, BatchSimulator::kStays);
  const std::string wanted = "has the length 5, expected " + std::to_string(actions_.size());
  expectRefused(
      simulator_, [&] { simulator_.step(few); }, "BatchSimulator::step: \"actions\" " + wanted);
  expectRefused(
      simulator_, [&] { simulator_.beginStep(few); }, wanted);
  expectRefused(
      simulator_, [&] { simulator_.step(actions_, three); }, "\"resets\" has the length 3");
  expectRefused(
      simulator_, [&] { simulator_.reset(three); }, "\"episodes\" has the length 3");
}

TEST_F(BatchCalls, WithNumbersOfNoEnvAreRefused) {
  const std::array<std::uint32_t, 2> envs{0, kEnvs};
  expectRefused(
      simulator_, [&] { static_cast<void>(simulator_.envState(1000000)); },
      "found env 1000000, expected one below 20");
  expectRefused(
      simulator_, [&] { static_cast<void>(simulator_.statistics(kEnvs)); }, "env 20");
  expectRefused(
      simulator_, [&] { static_cast<void>(simulator_.saveState(envs)); }, "env 20");
  expectRefused(
      simulator_, [&] { static_cast<void>(simulator_.linkOnBody(1000)); }, "link 1000");
  expectRefused(
      simulator_, [&] { static_cast<void>(simulator_.episodeNoise(kEnvs)); }, "env 20");
  expectRefused(
      simulator_, [&] { static_cast<void>(simulator_.actionsUnderWay(kEnvs)); }, "env 20");
  const std::vector<std::byte> two = simulator_.saveState(std::array<std::uint32_t, 2>{0, 1});
  expectRefused(
      simulator_, [&] { static_cast<void>(simulator_.restoreState(two, envs)); },
      "BatchSimulator::restoreState: found env 20, expected one below 20");
}

TEST_F(BatchCalls, ThatFollowSayWhereAllJointsAndObjectsAre) {
  std::vector<EnvState> states;
  std::vector<FollowedState> followed;
  for (std::size_t env = 0; env < kEnvs; ++env) states.push_back(simulator_.envState(env));
  for (const EnvState& state : states) {
    followed.push_back({.world_from_root = state.world_from_root,
                        .joint_positions = state.joint_positions,
                        .objects = state.objects,
                        .held = state.held});
  }
  const auto refused = [&](const FollowedState& state, const std::string& message) {
    std::vector<FollowedState> changed = followed;
    changed.back() = state;
    expectRefused(
        simulator_, [&] { simulator_.follow(actions_, changed); }, message);
  };
  FollowedState wrong = followed.back();
  wrong.joint_positions = wrong.joint_positions.first(0);
  refused(wrong, "\"states[].joint_positions\" has the length 0");
  wrong = followed.back();
  wrong.objects = wrong.objects.first(0);
  refused(wrong, "\"states[].objects\" has the length 0");
  wrong = followed.back();
  wrong.held = 99;
  refused(wrong, "found states[19].held 99, expected -1 or an index below 6");
  wrong.held = -2;
  refused(wrong, "found states[19].held -2");
  wrong = followed.back();
  wrong.world_from_root.translation.x = std::numeric_limits<float>::quiet_NaN();
  refused(wrong, "found states[19], which has world_from_root.translation (nan, ");
  wrong = followed.back();
  std::vector<Pose> objects(wrong.objects.begin(), wrong.objects.end());
  objects[1].rotation = {0, 0, 0, 0};
  wrong.objects = objects;
  refused(wrong, "which has objects[1].rotation (0, 0, 0, 0)");
  wrong = followed.back();
  std::vector<float> joints(wrong.joint_positions.begin(), wrong.joint_positions.end());
  joints.back() = 1e30F;
  wrong.joint_positions = joints;
  refused(wrong, "which has joint_positions[");
  expectRefused(
      simulator_, [&] { simulator_.follow(actions_, std::span(followed).first(1)); }, "\"states\"");
  simulator_.follow(actions_, followed);
}

TEST_F(BatchCalls, ThatWouldMeetAHalfStepAreRefused) {
  BatchSimulator other = BatchSimulator::create(world_.world(), optionsFor(kEnvs, 2)).value();
  other.step(actions_);
  const std::vector<std::byte> state = simulator_.saveState();
  const std::vector<std::int32_t> stays(kEnvs, BatchSimulator::kStays);
  simulator_.beginStep(actions_);
  const auto refused = [](const auto& call, const std::string& name) {
    EXPECT_THAT(call, ThrowsMessage<ErrorException>(HasSubstr(
                          name + ": found a step that has begun; end it first, with endStep()")));
  };
  refused([&] { simulator_.beginStep(actions_); }, "beginStep");
  refused([&] { simulator_.step(actions_); }, "step");
  refused([&] { simulator_.reset(stays); }, "reset");
  refused([&] { simulator_.restart(1); }, "restart");
  refused([&] { static_cast<void>(simulator_.saveState()); }, "saveState");
  refused([&] { static_cast<void>(simulator_.restoreState(state)); }, "restoreState");
  refused([&] { static_cast<void>(simulator_.envState(0)); }, "envState");
  refused([&] { simulator_.follow(actions_, {}); }, "follow");
  refused([&] { static_cast<void>(simulator_.episodeNoise(0)); }, "episodeNoise");
  refused([&] { static_cast<void>(simulator_.actionsUnderWay(0)); }, "actionsUnderWay");
  refused([&] { static_cast<void>(simulator_.statistics()); }, "statistics");
  refused([&] { static_cast<void>(simulator_.statistics(0)); }, "statistics");
  refused([&] { simulator_.samplePhases(1); }, "samplePhases");
  refused([&] { static_cast<void>(simulator_.phaseTimes()); }, "phaseTimes");
  simulator_.endStep();
  EXPECT_THAT([&] { simulator_.endStep(); },
              ThrowsMessage<ErrorException>(HasSubstr("found no step that has begun")));
  other.step(actions_);
  EXPECT_EQ(simulator_.saveState(), other.saveState());
}

}  // namespace
}  // namespace galactic::test::batch_calls_test
