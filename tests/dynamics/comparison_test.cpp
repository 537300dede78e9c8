// Recorded runs in both worlds: they agree where they must, and what is missed or invented is
// found.
#include "dynamics/episodes/comparison.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <random>
#include <stdexcept>
#include <string>

#include "dynamics/episodes/episode_source.h"
#include "dynamics/episodes/robot_driver.h"
#include "dynamics/episodes/trace.h"
#include "dynamics/made_robot.h"
#include "dynamics/report/report.h"
#include "support/scratch_folder.h"
#include "support/test_meshes.h"

namespace galactic::test::comparison_test {
namespace {

using dynamics::ArmDrive;
using dynamics::EpisodeComparison;
using dynamics::EpisodeLane;
using testing::Each;
using testing::Lt;

constexpr std::uint32_t kSteps = 40;

/// The small home without its table: the robot in the middle, all objects in a corner.
WorldFields emptyRoom(std::vector<Block> blocks) {
  WorldFields fields = smallHomeWorld();
  blocks.push_back({{0, -0.25F, 0}, {3, 0, 3}});
  fields.scene = BoxRoom(std::move(blocks)).fields(fields.objects.radii);
  for (auto& episode : fields.episodes.episodes) {
    episode.base_position = {1.2F, 0, 1.5F};
    episode.goal.translation = {2.8F, 0, 2.8F};
  }
  float x = 2.8F;
  for (Placement& placement : fields.episodes.placements) {
    placement.pose = {{x, 0.001F, 2.8F}, {}};
    x -= 0.2F;
    if (x < 2.3F) x = 2.8F;
  }
  return fields;
}

/// A world, the run of a policy in it, and what it is made of in the dynamics.
class RecordedRun {
 public:
  /// `actions` fills the actions of one env.
  template <class Policy>
  RecordedRun(const WorldFields& fields, const Policy& policy)
      : world_path_(writeWorld(folder_, fields)),
        world_(World::open(std::span(&world_path_, 1)).value()) {
    options_.envs = 2;
    options_.threads = 1;
    options_.task.most_steps = kSteps;
    record(policy);
  }

  [[nodiscard]] std::vector<dynamics::EpisodeTrace> traces(std::size_t most = 0) const {
    auto reader = RecordingReader::open(recording());
    return dynamics::tracesOf(reader.value(), world_, most).value();
  }

  /// The dynamics world is of `blocks` and has the small home's objects.
  [[nodiscard]] dynamics::Sources sources(const std::vector<Block>& blocks) const {
    MeshBuilder mesh;
    mesh.box({0, -0.25F, 0}, {3, 0, 3});
    for (const Block& block : blocks) mesh.box(block.min, block.max);
    dynamics::Sources sources;
    for (const Scene& scene : world_.scenes()) {
      sources.scenes.emplace(scene.name(), dynamics::makeSceneShape(mesh.build()));
    }
    for (const std::string_view name : world_.episodes().objectNames()) {
      const auto box = boxPoints({0, 0.05F, 0}, {0.05F, 0.05F, 0.05F});
      sources.objects.emplace(name, dynamics::makeObjectShape({.hulls = {box}, .mass = 0.5}));
    }
    sources.robot = smallHomeParts();
    sources.robot_shape = dynamics::makeRobotShape(sources.robot);
    return sources;
  }

  /// Replays an episode.
  [[nodiscard]] EpisodeComparison compare(const dynamics::EpisodeTrace& trace,
                                          const dynamics::Sources& sources, ArmDrive arm) const {
    const dynamics::WorldOptions world_options{.arm = arm};
    const auto lane = EpisodeLane::create(world_, options_, std::nullopt).value();
    return compareEpisode(trace, *lane, {world_, options_, sources, world_options},
                          recordedActions(trace))
        .value();
  }
  [[nodiscard]] EpisodeComparison first(const dynamics::Sources& sources, ArmDrive arm) const {
    return compare(traces().front(), sources, arm);
  }

  [[nodiscard]] const World& world() const { return world_; }
  [[nodiscard]] const SimulationOptions& options() const { return options_; }
  [[nodiscard]] std::filesystem::path recording() const { return folder_.path() / "run.rec"; }

 private:
  template <class Policy>
  void record(const Policy& policy) {
    BatchSimulator simulator = BatchSimulator::create(world_, options_).value();
    const auto count = static_cast<std::uint32_t>(simulator.actionCount());
    auto writer = RecordingWriter::create(recording(), {options_, count, stampsOf(world_)});
    std::vector<float> actions(simulator.envCount() * count);
    for (std::uint32_t n = 0; n < 2 * kSteps + 5; ++n) {
      for (std::size_t env = 0; env < simulator.envCount(); ++env) {
        policy(n, std::span(actions).subspan(env * count, count));
      }
      simulator.step(actions);
      EXPECT_TRUE(writer->append(actions, digestOf(simulator)));
    }
    EXPECT_TRUE(writer->finish());
  }

  ScratchFolder folder_;
  std::filesystem::path world_path_;
  World world_;
  SimulationOptions options_;
};

/// Wanders about its place and moves its arm; the hand stays empty.
auto wander() {
  return [random = std::make_shared<std::mt19937>(7)](std::uint32_t, std::span<float> actions) {
    std::uniform_real_distribution<float> any(-1, 1);
    for (float& action : actions) action = any(*random);
    actions[kForward] *= 0.3F;
    actions[kHand] = 0;
    actions[kTerminate] = 0;
  };
}

auto driveAhead() {
  return [](std::uint32_t, std::span<float> actions) {
    std::ranges::fill(actions, 0.0F);
    actions[kForward] = 0.2F;
  };
}

TEST(BothWorlds, AgreeInAnEmptyRoomWithAKinematicArm) {
  const RecordedRun run(emptyRoom({}), wander());
  const auto traces = run.traces();
  // Of two envs two episodes each; the third of each is not finished.
  ASSERT_EQ(traces.size(), 4U);
  for (const dynamics::EpisodeTrace& trace : traces) {
    const EpisodeComparison replay = run.compare(trace, run.sources({}), ArmDrive::kKinematic);
    ASSERT_EQ(replay.base_gap.size(), kSteps);
    EXPECT_THAT(replay.base_gap, Each(Lt(1e-4F)));
    EXPECT_THAT(replay.grip_gap, Each(Lt(1e-4F)));
    EXPECT_EQ(replay.missed_steps, 0U);
    EXPECT_EQ(replay.hindered, 0U);
    EXPECT_EQ(replay.disturbed, 0U);
    EXPECT_EQ(replay.tracking_worst, 0);
    EXPECT_EQ(replay.end, EpisodeEnd::kTimeOut);
    EXPECT_EQ(replay.end_in_dynamics, EpisodeEnd::kTimeOut);
    EXPECT_EQ(replay.steps_in_dynamics, kSteps);
    EXPECT_FALSE(replay.parted);
  }
}

TEST(BothWorlds, PartInTheFirstStepInWhichTheirHandsHoldOtherThings) {
  const RecordedRun run(emptyRoom({}), wander());
  dynamics::EpisodeTrace trace = run.traces().front();
  for (std::size_t n = 5; n < 9; ++n) trace.steps.at(n).held = 0;
  const EpisodeComparison replay = run.compare(trace, run.sources({}), ArmDrive::kKinematic);
  EXPECT_EQ(replay.parted, 5U);
}

TEST(AMotorArm, FollowsTheSimulationCloselyInAnEmptyRoom) {
  const RecordedRun run(emptyRoom({}), wander());
  const EpisodeComparison replay = run.first(run.sources({}), ArmDrive::kMotors);
  EXPECT_THAT(replay.base_gap, Each(Lt(1e-4F)));
  EXPECT_THAT(replay.grip_gap, Each(Lt(0.1F)));
  EXPECT_GT(replay.tracking_worst, 1e-4);
}

TEST(AWallThatTheSimulationDoesNotKnow, IsMissed) {
  const RecordedRun run(emptyRoom({}), driveAhead());
  const Block wall{{1.7F, 0, 0}, {1.8F, 2, 3}};
  const EpisodeComparison replay = run.first(run.sources({wall}), ArmDrive::kKinematic);
  EXPECT_GT(replay.missed_steps, 5U);
  // The column grid is of a room without the wall.
  EXPECT_TRUE(
      replay.missed.contains({0, dynamics::Thing::kScene, dynamics::MissCause::kColumnCell}));
  ASSERT_TRUE(replay.deepest);
  EXPECT_GT(replay.deepest->depth, 0.05F);
  // In the dynamics the wall stops the base, in the simulation it goes on.
  EXPECT_GT(replay.base_gap.back(), 0.1F);
}

TEST(AWallThatIsNotThere, IsInvented) {
  const Block wall{{1.9F, 0, 0}, {2.0F, 2, 3}};
  const RecordedRun run(emptyRoom({wall}), driveAhead());
  const EpisodeComparison alone = run.first(run.sources({}), ArmDrive::kKinematic);
  EXPECT_GT(alone.hindered, 5U);
  EXPECT_EQ(alone.inventedSteps(), alone.hindered);
  EXPECT_EQ(alone.invented.at(dynamics::InventedCause::kScene), alone.hindered);
  EXPECT_EQ(alone.missed_steps, 0U);
  const EpisodeComparison same = run.first(run.sources({wall}), ArmDrive::kKinematic);
  EXPECT_EQ(same.hindered, alone.hindered);
  EXPECT_LT(same.inventedSteps(), same.hindered);
}

TEST(AReport, IsTheSameEachTime) {
  const RecordedRun run(emptyRoom({}), wander());
  const dynamics::Sources sources = run.sources({});
  const auto report = [&] {
    dynamics::Comparisons all;
    all.episodes.push_back(run.first(sources, ArmDrive::kMotors));
    all.worst = worstMoments(all.episodes, 10, dynamics::ComparisonMode::kReplay);
    return dynamics::reportJson(all, run.world(),
                                {.mode = dynamics::ComparisonMode::kReplay,
                                 .played = "run.rec",
                                 .world = {},
                                 .loop = {},
                                 .warnings = {}});
  };
  EXPECT_EQ(report(), report());
}

TEST(AThinShelf, IsMissedBetweenTwoStepsThatJumpOverIt) {
  // The arm, 4 cm thick, goes up by 5 cm in a step: from under the shelf to over it.
  const RecordedRun run(emptyRoom({}), [](std::uint32_t, std::span<float> actions) {
    std::ranges::fill(actions, 0.0F);
    actions[kLift] = 1;
  });
  const dynamics::EpisodeTrace trace = run.traces().front();
  const Pose grip = dynamics::gripOf(run.world().robot(), trace.start_root, trace.start_positions);
  constexpr float kStep = 0.05F;
  const Vec3 middle = grip.translation + Vec3{0, 4.5F * kStep, 0};
  const Vec3 half{0.06F, 0.002F, 0.06F};
  const Block shelf{middle - half, middle + half};
  const EpisodeComparison replay = run.first(run.sources({shelf}), ArmDrive::kKinematic);
  ASSERT_FALSE(replay.missed.empty());
  for (const auto& [key, steps] : replay.missed) {
    EXPECT_EQ(std::get<dynamics::MissCause>(key), dynamics::MissCause::kTunneled);
    EXPECT_EQ(steps, 1U);
  }
}

/// A trace in which a long arm turns more than half around, and its first step whose angle is a
/// turn less than that of the step before.
struct TurningArm {
  dynamics::EpisodeTrace trace;
  std::size_t step = 0;

  /// Where the grip is when the shoulder is at an angle, and the other joints as after the step.
  [[nodiscard]] Vec3 gripAt(const Robot& robot, float shoulder) const {
    std::vector<float> positions = trace.steps[step].positions;
    positions[kShoulder] = shoulder;
    return dynamics::gripOf(robot, trace.start_root, positions).translation;
  }
};

TurningArm turningArm(const RecordedRun& run) {
  TurningArm arm{run.traces().front()};
  const auto shoulder = [&](std::size_t n) { return arm.trace.steps[n].positions[kShoulder]; };
  for (arm.step = 1; arm.step < arm.trace.steps.size(); ++arm.step) {
    if (shoulder(arm.step - 1) - shoulder(arm.step) > 3) return arm;
  }
  throw std::runtime_error("the shoulder never goes beyond half a turn");
}

TEST(AJointThatTurnsBeyondHalfATurn, TakesTheShortWayBetweenTwoSteps) {
  const RecordedRun run(emptyRoom({}), [](std::uint32_t, std::span<float> actions) {
    std::ranges::fill(actions, 0.0F);
    actions[kShoulder] = actions[kArm] = 1;
  });
  const Robot& robot = run.world().robot();
  const TurningArm arm = turningArm(run);
  const auto plateAt = [&](float shoulder) {
    constexpr Vec3 kHalf{0.06F, 0.06F, 0.002F};
    const Vec3 middle = arm.gripAt(robot, shoulder);
    return Block{middle - kHalf, middle + kHalf};
  };
  const float before = arm.trace.steps[arm.step - 1].positions[kShoulder];
  const float after = arm.trace.steps[arm.step].positions[kShoulder];
  // On the other side of the robot, where the mean of the two angles is.
  const Block aside = plateAt(0.5F * (before + after));
  EXPECT_TRUE(run.first(run.sources({aside}), ArmDrive::kKinematic).missed.empty());
  const Block on_its_way = plateAt(0.5F * (before + after) + std::numbers::pi_v<float>);
  const auto missed = run.first(run.sources({on_its_way}), ArmDrive::kKinematic).missed;
  ASSERT_FALSE(missed.empty());
  for (const auto& [key, steps] : missed) {
    EXPECT_EQ(std::get<dynamics::MissCause>(key), dynamics::MissCause::kTunneled);
  }
}

TEST(AClosedLoop, SolvesInTheDynamicsWhatItSolvesInTheSimulation) {
  const RecordedRun run(smallHomeWorld(), driveAhead());
  SimulationOptions options = run.options();
  options.task.most_steps = 300;
  const dynamics::Sources sources = run.sources({{{1, 0, 1}, {2, 0.7F, 2}}});
  const dynamics::WorldOptions world_options{.arm = ArmDrive::kKinematic};
  const auto lane = EpisodeLane::create(run.world(), options, dynamics::ClosedLoop{}).value();
  const auto play = [&](std::uint32_t episode) {
    const auto trace = traceOf(episode, *lane).value();
    return compareEpisode(trace, *lane, {run.world(), options, sources, world_options},
                          policyActions(*lane))
        .value();
  };
  const EpisodeComparison first = play(0);
  EXPECT_EQ(first.end, EpisodeEnd::kSuccess);
  EXPECT_EQ(first.end_in_dynamics, EpisodeEnd::kSuccess);
  EXPECT_TRUE(first.picked_in_dynamics);
  EXPECT_TRUE(first.success_settled);
  EXPECT_EQ(first.disturbed, 0U) << "what the hand carried was not in its way";
  EXPECT_EQ(first.rests.size(), 1U);
  // What a lane did before changes nothing.
  static_cast<void>(play(1));
  const EpisodeComparison again = play(0);
  EXPECT_EQ(again.grip_gap, first.grip_gap);
  EXPECT_EQ(again.steps_in_dynamics, first.steps_in_dynamics);
}

TEST(AClosedLoop, HasPatienceWithMotors) {
  const RecordedRun run(smallHomeWorld(), driveAhead());
  SimulationOptions options = run.options();
  options.task.most_steps = 500;
  const dynamics::Sources sources = run.sources({{{1, 0, 1}, {2, 0.7F, 2}}});
  // A third of the usual gain: joints lag behind by several actions.
  const dynamics::WorldOptions world_options{.position_gain = 0.1};
  const auto lane = EpisodeLane::create(run.world(), options, dynamics::ClosedLoop{}).value();
  for (const std::uint32_t episode : {0U, 1U}) {
    const auto trace = traceOf(episode, *lane).value();
    const EpisodeComparison played =
        compareEpisode(trace, *lane, {run.world(), options, sources, world_options},
                       policyActions(*lane))
            .value();
    EXPECT_EQ(played.end, EpisodeEnd::kSuccess) << episode;
    EXPECT_EQ(played.end_in_dynamics, EpisodeEnd::kSuccess) << episode;
    EXPECT_GT(played.steps_in_dynamics, played.steps) << "it waited";
    // It looks at its own targets: each joint is asked for once what the plan wants.
    EXPECT_LT(4 * played.steps_in_dynamics, 9 * played.steps) << episode;
  }
}

TEST(AnEpisode, EndsWithoutASuccessWhereTheEngineLosesTheRobotInItsFirstStep) {
  const RecordedRun run(smallHomeWorld(), driveAhead());
  SimulationOptions options = run.options();
  options.task.most_steps = 300;
  dynamics::Sources sources = run.sources({{{1, 0, 1}, {2, 0.7F, 2}}});
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  for (dynamics::LinkPart& link : sources.robot.links) {
    link.inertia = {.mass = kInfinite, .center = {}, .moments = {kInfinite, kInfinite, kInfinite}};
  }
  const auto lane = EpisodeLane::create(run.world(), options, dynamics::ClosedLoop{}).value();
  const auto trace = traceOf(0, *lane).value();
  for (const dynamics::ActionSource& actions : {recordedActions(trace), policyActions(*lane)}) {
    const EpisodeComparison played =
        compareEpisode(trace, *lane, {run.world(), options, sources, {}}, actions).value();
    EXPECT_EQ(played.end, EpisodeEnd::kSuccess);
    EXPECT_EQ(played.end_in_dynamics, EpisodeEnd::kNone);
    EXPECT_EQ(played.steps_in_dynamics, 0U);
    EXPECT_TRUE(played.base_gap.empty());
    EXPECT_TRUE(played.grip_gap.empty());
    EXPECT_FALSE(played.picked_in_dynamics);
    EXPECT_FALSE(played.success_settled);
    const std::string report = dynamics::reportJson({{played}, {}}, run.world(), {});
    EXPECT_THAT(report, testing::HasSubstr("\"last_grip_gap\": null,"));
  }
}

TEST(AReleasedObject, IsWhereTheEngineKnewItLast) {
  const RecordedRun run(smallHomeWorld(), driveAhead());
  SimulationOptions options = run.options();
  options.task.most_steps = 300;
  dynamics::Sources sources = run.sources({{{1, 0, 1}, {2, 0.7F, 2}}});
  const auto box = boxPoints({0, 0.05F, 0}, {0.05F, 0.05F, 0.05F});
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  for (auto& [name, shape] : sources.objects) {
    shape = dynamics::makeObjectShape({.hulls = {box}, .mass = kInfinite});
  }
  const auto lane = EpisodeLane::create(run.world(), options, dynamics::ClosedLoop{}).value();
  const auto trace = traceOf(0, *lane).value();
  const EpisodeComparison played =
      compareEpisode(trace, *lane, {run.world(), options, sources, {}}, recordedActions(trace))
          .value();
  EXPECT_EQ(played.steps_in_dynamics, 0U) << "an object was lost, too";
  EXPECT_EQ(played.disturbed, trace.start_objects.size());
  ASSERT_EQ(played.rests.size(), 1U);
  EXPECT_EQ(played.rests.front().world_from_object, trace.releases.front().world_from_object);
  EXPECT_EQ(played.rests.front().displacement, 0.0F);
}

/// The n-th episode of a source in both worlds.
EpisodeComparison compareOf(const dynamics::EpisodeSource& episodes, std::size_t n,
                            const RecordedRun& run, const dynamics::Sources& sources) {
  const dynamics::WorldOptions world_options{.arm = ArmDrive::kKinematic};
  const auto lane = episodes.makeLane().value();
  const auto trace = episodes.trace(n, *lane).value();
  return compareEpisode(trace, *lane, {run.world(), episodes.options(), sources, world_options},
                        episodes.actions(trace, *lane))
      .value();
}

TEST(RecordedEpisodes, AreReplayed) {
  const RecordedRun run(emptyRoom({}), wander());
  const dynamics::Sources sources = run.sources({});
  const auto traces = run.traces();
  EXPECT_EQ(dynamics::recordedEpisodes(run.recording(), run.world(), 0).value()->count(), 4U);
  const auto episodes = dynamics::recordedEpisodes(run.recording(), run.world(), 3).value();
  ASSERT_EQ(episodes->count(), 3U);
  const EpisodeComparison last = compareOf(*episodes, 2, run, sources);
  EXPECT_EQ(last.env, traces[2].env);
  EXPECT_EQ(last.episode, traces[2].episode);
  EXPECT_EQ(last.grip_gap, run.compare(traces[2], sources, ArmDrive::kKinematic).grip_gap);
}

TEST(RecordedEpisodes, LeaveAnEpisodeOpenWhereTheirActionsRunOut) {
  const RecordedRun run(emptyRoom({}), wander());
  dynamics::EpisodeTrace trace = run.traces().front();
  constexpr std::size_t kShort = 10;
  trace.steps.resize(kShort);
  EXPECT_FALSE(recordedActions(trace)(kShort - 1)->empty());
  EXPECT_TRUE(recordedActions(trace)(kShort)->empty());
  const EpisodeComparison replay = run.compare(trace, run.sources({}), ArmDrive::kKinematic);
  EXPECT_EQ(replay.steps_in_dynamics, kShort);
  EXPECT_EQ(replay.end_in_dynamics, EpisodeEnd::kNone);
}

TEST(PlayedEpisodes, AreThoseOfThePolicyWithTheOptionsOfTheUser) {
  const RecordedRun run(smallHomeWorld(), driveAhead());
  const dynamics::Sources sources = run.sources({{{1, 0, 1}, {2, 0.7F, 2}}});
  const dynamics::LoopOptions loop{.seed = 3, .task = {{"episode-steps", "300"}}};
  const auto episodes = dynamics::playedEpisodes({}, loop, run.world(), 1).value();
  ASSERT_EQ(episodes->count(), 1U);
  EXPECT_EQ(episodes->options().task.most_steps, 300U);
  EXPECT_EQ(episodes->options().seed, 3U);
  const EpisodeComparison played = compareOf(*episodes, 0, run, sources);
  EXPECT_EQ(played.end, EpisodeEnd::kSuccess);
  EXPECT_EQ(played.end_in_dynamics, EpisodeEnd::kSuccess);
  const auto wrong = dynamics::playedEpisodes({}, {.task = {{"gravity", "1"}}}, run.world(), 1);
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error().where, "--set");
}

TEST(ARecordingOfAnotherWorld, IsRefused) {
  const RecordedRun run(emptyRoom({}), driveAhead());
  const RecordedRun other(emptyRoom({{{2.4F, 0, 0}, {2.5F, 2, 3}}}), driveAhead());
  auto reader = RecordingReader::open(run.recording());
  const auto traces = dynamics::tracesOf(reader.value(), other.world(), 0);
  ASSERT_FALSE(traces);
  EXPECT_EQ(traces.error().code, ErrorCode::kInvalidInput);
}

TEST(AShare, HasWilsonsInterval) {
  // Brown, Cai and DasGupta (2001): 8 of 10.
  const dynamics::Share share = dynamics::wilson(8, 10);
  EXPECT_NEAR(share.low, 0.4902, 1e-4);
  EXPECT_NEAR(share.high, 0.9433, 1e-4);
  EXPECT_EQ(dynamics::wilson(0, 0).high, 0);
  EXPECT_NEAR(dynamics::wilson(0, 20).high, 0.1611, 1e-4);
}

}  // namespace
}  // namespace galactic::test::comparison_test
