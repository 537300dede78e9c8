// What a track keeps is what the simulator said.
#include "view/run_track.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "galactic/batch_simulator.h"
#include "support/homes/small_home.h"

namespace galactic::test::run_track_test {
namespace {

constexpr std::size_t kEnvs = 3;
constexpr std::size_t kKept = 2;

/// Drives, lifts and grasps, differently in each env.
std::vector<float> actionsOf(const BatchSimulator& simulator, std::size_t step) {
  std::vector<float> actions(simulator.envCount() * simulator.actionCount());
  for (std::size_t n = 0; n < actions.size(); ++n) {
    actions[n] = std::sin(0.7F * static_cast<float>(n + 1) + 0.05F * static_cast<float>(step));
  }
  for (std::size_t env = 0; env < simulator.envCount(); ++env) {
    actions[env * simulator.actionCount() + kTerminate] = 0;
  }
  return actions;
}

class RunTrackTest : public testing::Test {
 protected:
  RunTrackTest() {
    SimulationOptions options;
    options.envs = kEnvs;
    options.task.most_steps = 25;
    simulator_.emplace(*BatchSimulator::create(home_.world(), options));
  }

  SmallHome home_;
  std::optional<BatchSimulator> simulator_;
};

/// Where the track has an object in a frame, as a reader of it finds out.
Pose trackedPose(const World& world, const EnvTrack& track, std::size_t frame,
                 std::uint32_t placement) {
  std::size_t begin = frame;
  while (begin > 0 && track.endings[begin - 1] == EpisodeEnd::kNone) --begin;
  const Episode& episode = world.episodes().episodes()[track.episodes[frame]];
  Pose pose = world.episodes().placements(episode)[placement].pose;
  for (const ObjectMove& move : track.moves) {
    if (move.frame >= begin && move.frame <= frame && move.placement == placement) {
      pose = move.world_from_object;
    }
  }
  return pose;
}

void expectFrame(const World& world, const BatchSimulator& simulator, const EnvTrack& track,
                 std::size_t env) {
  const std::size_t frame = track.episodes.size() - 1;
  const EnvState state = simulator.envState(env);
  const EnvObjects objects = simulator.envObjects(env);
  EXPECT_EQ(track.episodes[frame], state.episode);
  EXPECT_EQ(track.held[frame], state.held);
  EXPECT_EQ(track.world_from_root[frame], state.world_from_root);
  const std::size_t positions = world.robot().positionCount();
  for (std::size_t n = 0; n < positions; ++n) {
    EXPECT_EQ(track.joints[frame * positions + n], state.joint_positions[n]);
  }
  for (std::uint32_t n = 0; n < objects.objects.size(); ++n) {
    const bool is_held = objects.held == static_cast<std::int32_t>(n);
    EXPECT_EQ(trackedPose(world, track, frame, n),
              is_held ? objects.world_from_held : objects.objects[n]);
  }
}

TEST_F(RunTrackTest, KeepsTheStateOfEachStepAcrossEpisodes) {
  RunTrack track(home_.world(), *simulator_, kKept);
  ASSERT_EQ(track.envs().size(), kKept);
  std::size_t ended = 0;
  for (std::size_t step = 0; step < 80; ++step) {
    const std::vector<float> actions = actionsOf(*simulator_, step);
    simulator_->step(actions);
    track.add(*simulator_, actions);
    for (std::size_t env = 0; env < kKept; ++env) {
      const EnvTrack& kept = track.envs()[env];
      expectFrame(home_.world(), *simulator_, kept, env);
      EXPECT_EQ(kept.rewards.back(), simulator_->rewards()[env]);
      EXPECT_EQ(kept.endings.back(), simulator_->endings()[env]);
      ended += kept.endings.back() != EpisodeEnd::kNone ? 1U : 0U;
    }
  }
  EXPECT_EQ(track.steps(), 80U);
  EXPECT_GE(ended, 2 * kKept) << "no episode ended: nothing was tested across episodes";
}

/// The number of an episode whose target is not the first of its objects.
std::int32_t episodeOfALaterTarget(const World& world) {
  const auto episodes = world.episodes().episodes();
  const auto found = std::find_if(episodes.begin(), episodes.end(),
                                  [](const Episode& one) { return one.target > 0; });
  if (found == episodes.end()) throw std::runtime_error("all targets are the first object");
  return static_cast<std::int32_t>(found - episodes.begin());
}

TEST_F(RunTrackTest, KnowsTheHeldTargetAmongAllPlacementsWhereItIsAlone) {
  SimulationOptions options;
  options.envs = 1;
  options.task.distractors = false;
  BatchSimulator alone = *BatchSimulator::create(home_.world(), options);
  const std::int32_t number = episodeOfALaterTarget(home_.world());
  alone.reset({&number, 1});
  RunTrack track(home_.world(), alone, 1);
  EXPECT_EQ(track.envs()[0].held.back(), -1);
  const EnvState state = alone.envState(0);
  Pose lifted = state.objects[0];
  lifted.translation.y += 0.5F;
  const FollowedState grasped{.world_from_root = state.world_from_root,
                              .joint_positions = state.joint_positions,
                              .objects = {&lifted, 1},
                              .held = 0};
  const std::vector<float> actions(alone.actionCount());
  alone.follow(actions, {&grasped, 1});
  track.add(alone, actions);
  EXPECT_TRUE(track.isTargetOnly());
  const auto target = home_.world().episodes().episodes()[static_cast<std::size_t>(number)].target;
  EXPECT_EQ(track.envs()[0].held.back(), static_cast<std::int32_t>(target));
  EXPECT_EQ(track.envs()[0].moves.back().placement, target);
}

TEST_F(RunTrackTest, CountsWhatHappened) {
  RunTrack track(home_.world(), *simulator_, kEnvs);
  std::uint64_t refused = 0;
  for (std::size_t step = 0; step < 80; ++step) {
    const std::vector<float> actions = actionsOf(*simulator_, step);
    simulator_->step(actions);
    track.add(*simulator_, actions);
  }
  for (const EnvTrack& env : track.envs()) {
    for (const std::uint8_t events : env.events) {
      refused += (events & static_cast<unsigned>(RunEvent::kRefuse)) != 0 ? 1U : 0U;
    }
  }
  EXPECT_EQ(refused, simulator_->statistics().refused);
  EXPECT_GT(refused, 0U);
}

TEST_F(RunTrackTest, DistancesAreThoseOfTheStepThatEndedAnEpisode) {
  RunTrack track(home_.world(), *simulator_, 1);
  const std::vector<ObservationPart>& parts = simulator_->observationParts();
  std::size_t at_end = 0;
  for (std::size_t step = 0; step < 60; ++step) {
    const std::vector<float> actions = actionsOf(*simulator_, step);
    simulator_->step(actions);
    track.add(*simulator_, actions);
    const bool ended = simulator_->dones()[0] != 0;
    at_end += ended ? 1U : 0U;
    const auto row = ended ? simulator_->finalObservations() : simulator_->observations();
    for (std::size_t n = 0; n < kTrackDistances.size(); ++n) {
      const auto part = std::find_if(parts.begin(), parts.end(), [n](const ObservationPart& one) {
        return one.name == kTrackDistances[n];
      });
      ASSERT_NE(part, parts.end());
      const float length = std::hypot(row[part->first], row[part->first + 1], row[part->first + 2]);
      EXPECT_EQ(track.envs()[0].distances[step * kTrackDistances.size() + n], length);
    }
  }
  EXPECT_GT(at_end, 0U);
}

TEST_F(RunTrackTest, AppendsTheEnvsOfAnotherRun) {
  RunTrack both(home_.world(), *simulator_, kKept);
  const RunTrack start = both;
  for (std::size_t step = 0; step < 3; ++step) {
    const std::vector<float> actions = actionsOf(*simulator_, step);
    simulator_->step(actions);
    both.add(*simulator_, actions);
  }
  RunTrack longer = start;
  longer.append(both);
  ASSERT_EQ(longer.envs().size(), 2 * kKept);
  EXPECT_EQ(longer.steps(), 3U);
  EXPECT_EQ(longer.envs()[kKept].actions, both.envs()[0].actions);
  EXPECT_TRUE(longer.envs()[0].rewards.empty());
}

TEST_F(RunTrackTest, KeepsWhenAnEnvHasPlayedItsShare) {
  SimulationOptions options = simulator_->options();
  options.order = EpisodeOrder::kPartition;
  options.envs = 2;
  options.task.most_steps = 10;
  BatchSimulator shares = *BatchSimulator::create(home_.world(), options);
  RunTrack track(home_.world(), shares, 2);
  for (std::size_t step = 0; step < 25; ++step) {
    const std::vector<float> actions = actionsOf(shares, step);
    shares.step(actions);
    track.add(shares, actions);
  }
  // Three episodes can be played: the first env has two of them.
  constexpr std::array<std::size_t, 2> kBusyFrames{20, 10};
  for (std::size_t env = 0; env < 2; ++env) {
    const std::vector<std::uint8_t>& idle = track.envs()[env].idle;
    ASSERT_EQ(idle.size(), 26U);
    for (std::size_t frame = 0; frame < idle.size(); ++frame) {
      EXPECT_EQ(idle[frame] != 0, frame >= kBusyFrames[env]) << env << ", " << frame;
    }
  }
}

TEST_F(RunTrackTest, DistancesAreThoseOfAnEndThatIsNotLeft) {
  SimulationOptions options = simulator_->options();
  options.auto_reset = false;
  BatchSimulator stays = *BatchSimulator::create(home_.world(), options);
  RunTrack track(home_.world(), stays, 1);
  for (std::size_t step = 0; step < 25; ++step) {
    const std::vector<float> actions = actionsOf(stays, step);
    stays.step(actions);
    track.add(stays, actions);
  }
  ASSERT_EQ(track.envs()[0].endings.back(), EpisodeEnd::kTimeOut);
  const std::span<const float> row = stays.observations();
  EXPECT_EQ(track.envs()[0].distances[24 * kTrackDistances.size()],
            std::hypot(row[0], row[1], row[2]));
}

}  // namespace
}  // namespace galactic::test::run_track_test
