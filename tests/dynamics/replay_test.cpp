// Recorded runs in both worlds: they agree where they must, and what is missed or invented is
// found.
#include "dynamics/replay.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "dynamics/made_robot.h"
#include "dynamics/report.h"
#include "dynamics/robot_driver.h"
#include "dynamics/trace.h"
#include "support/scratch_folder.h"
#include "support/test_meshes.h"

namespace galactic::test::replay_test {
namespace {

using dynamics::ArmDrive;
using dynamics::EpisodeReplay;
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

  [[nodiscard]] EpisodeReplay first(const dynamics::Sources& sources, ArmDrive arm) const {
    return dynamics::replay(traces().front(), world_, options_, sources, {.arm = arm});
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
    const EpisodeReplay replay = dynamics::replay(trace, run.world(), run.options(),
                                                  run.sources({}), {.arm = ArmDrive::kKinematic});
    ASSERT_EQ(replay.base_gap.size(), kSteps);
    EXPECT_THAT(replay.base_gap, Each(Lt(1e-4F)));
    EXPECT_THAT(replay.grip_gap, Each(Lt(1e-4F)));
    EXPECT_EQ(replay.missed_steps, 0U);
    EXPECT_EQ(replay.hindered, 0U);
    EXPECT_EQ(replay.disturbed, 0U);
    EXPECT_EQ(replay.tracking_worst, 0);
    EXPECT_EQ(replay.end, EpisodeEnd::kTimeOut);
    EXPECT_FALSE(replay.success_there);
  }
}

TEST(AMotorArm, FollowsTheSimulationCloselyInAnEmptyRoom) {
  const RecordedRun run(emptyRoom({}), wander());
  const EpisodeReplay replay = run.first(run.sources({}), ArmDrive::kMotors);
  EXPECT_THAT(replay.base_gap, Each(Lt(1e-4F)));
  EXPECT_THAT(replay.grip_gap, Each(Lt(0.1F)));
  EXPECT_GT(replay.tracking_worst, 1e-4);
}

TEST(AWallThatTheSimulationDoesNotKnow, IsMissed) {
  const RecordedRun run(emptyRoom({}), driveAhead());
  const Block wall{{1.7F, 0, 0}, {1.8F, 2, 3}};
  const EpisodeReplay replay = run.first(run.sources({wall}), ArmDrive::kKinematic);
  EXPECT_GT(replay.missed_steps, 5U);
  EXPECT_TRUE(replay.missed.contains({0, dynamics::Thing::kScene}));
  // There the wall stops the base, here it goes on.
  EXPECT_GT(replay.base_gap.back(), 0.1F);
}

TEST(AWallThatIsNotThere, IsInvented) {
  const Block wall{{1.9F, 0, 0}, {2.0F, 2, 3}};
  const RecordedRun run(emptyRoom({wall}), driveAhead());
  const EpisodeReplay alone = run.first(run.sources({}), ArmDrive::kKinematic);
  EXPECT_GT(alone.hindered, 5U);
  EXPECT_EQ(alone.invented, alone.hindered);
  EXPECT_EQ(alone.missed_steps, 0U);
  const EpisodeReplay same = run.first(run.sources({wall}), ArmDrive::kKinematic);
  EXPECT_EQ(same.hindered, alone.hindered);
  EXPECT_LT(same.invented, same.hindered);
}

TEST(AReport, IsTheSameEachTime) {
  const RecordedRun run(emptyRoom({}), wander());
  const dynamics::Sources sources = run.sources({});
  const auto report = [&] {
    const std::vector<EpisodeReplay> replays{run.first(sources, ArmDrive::kMotors)};
    return dynamics::reportJson(replays, run.world(), {.recording = "run.rec", .warnings = {}});
  };
  EXPECT_EQ(report(), report());
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
}  // namespace galactic::test::replay_test
