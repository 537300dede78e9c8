// Plans of one episode after others that failed.
#include "scripted/planner.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "galactic/batch_simulator.h"
#include "scripted/scripted_policy.h"
#include "scripted_world.h"

namespace galactic::test::planner_test {
namespace {

using scripted::Plan;
using scripted::Planner;
using scripted::Stance;

/// A cube on a table, its goal beside it, and room on three sides.
ScriptedWorld tableWorld() {
  MeshBuilder room = madeRoom(4, 3);
  room.box({2.2F, 0, 1}, {2.8F, 0.5F, 2});
  return stickWorld(room.build(), {0.8F, 0, 1.5F}, {2.4F, 0.501F, 1.3F}, {2.4F, 0.501F, 1.7F});
}

SimulationOptions oneEnv() {
  SimulationOptions options;
  options.envs = 1;
  options.threads = 1;
  return options;
}

bool isNear(const Vec3& a, const Vec3& b, float distance) {
  return dot(a - b, a - b) < distance * distance;
}

/// Whether somebody who looks at both would call them the same.
bool areSame(const Stance& a, const Stance& b) {
  return isNear(a.base.position, b.base.position, 0.05F) && isNear(a.grip, b.grip, 0.02F) &&
         isNear(a.approach, b.approach, 0.1F);
}

std::size_t countOther(const std::vector<Stance>& stances) {
  std::vector<Stance> others;
  for (const Stance& stance : stances) {
    const bool is_known =
        std::ranges::any_of(others, [&](const Stance& other) { return areSame(stance, other); });
    if (!is_known) others.push_back(stance);
  }
  return others.size();
}

TEST(Planner, ComesToAnotherStanceAfterOneThatFailedAsLongAsThereIsOne) {
  const ScriptedWorld made = tableWorld();
  BatchSimulator simulator = MemoryPack::opened(BatchSimulator::create(made.world(), oneEnv()));
  const EnvState state = simulator.envState(0);
  Planner planner(made.world(), oneEnv());
  std::vector<Stance> failed;
  constexpr std::uint32_t kPlans = 40;
  for (std::uint32_t n = 0; n < kPlans; ++n) {
    const Plan plan = planner.planPick(state, {n, failed});
    // Where all have failed, one of them is better than none.
    ASSERT_EQ(plan.trouble, ScriptedTrouble::kNone) << n;
    ASSERT_EQ(plan.steps.back().kind, scripted::PlanStep::Kind::kGrasp);
    failed.push_back(plan.stance);
  }
  EXPECT_EQ(countOther({failed.begin(), failed.begin() + ScriptedPolicy::kMostPlans}),
            ScriptedPolicy::kMostPlans);
  EXPECT_LT(countOther(failed), kPlans);
}

/// Where the robot is, of each time that the policy closes an empty hand or opens a full one, as
/// `is_empty` says; neither does anything. Until it gives up.
std::vector<Stance> standsInVain(const World& world, bool is_empty) {
  BatchSimulator simulator = MemoryPack::opened(BatchSimulator::create(world, oneEnv()));
  ScriptedPolicy policy = MemoryPack::opened(ScriptedPolicy::create(world, oneEnv()));
  std::vector<float> actions(simulator.actionCount());
  float& hand = actions.rbegin()[1];
  std::vector<Stance> stances;
  for (std::uint32_t step = 0; step < TaskOptions{}.most_steps; ++step) {
    policy.act(simulator, actions);
    if (policy.phase(0) == ScriptedPhase::kGaveUp) break;
    const EnvState state = simulator.envState(0);
    const bool does_something = state.held < 0 ? hand > 0.5F : hand < 0.5F;
    if (does_something && (state.held < 0) == is_empty) {
      const Pose& grip = state.world_from_grip;
      stances.push_back({{state.world_from_root.translation, 0},
                         grip.translation,
                         rotate(grip.rotation, {1, 0, 0})});
      hand = is_empty ? 0.0F : 1.0F;
    }
    simulator.step(actions);
  }
  return stances;
}

TEST(Planner, LetsThePolicyTryElsewhereWhatTheHandHasMissed) {
  const ScriptedWorld made = tableWorld();
  for (const bool is_empty : {true, false}) {
    const std::vector<Stance> stances = standsInVain(made.world(), is_empty);
    EXPECT_GE(stances.size(), 4U) << is_empty;
    EXPECT_EQ(countOther(stances), stances.size()) << is_empty;
  }
}

bool areEqual(const Stance& a, const Stance& b) {
  return a.base.position == b.base.position && a.base.yaw == b.base.yaw && a.grip == b.grip &&
         a.approach == b.approach;
}

/// Whether two plans are the same, bit for bit.
bool areEqual(const Plan& a, const Plan& b) {
  return a.trouble == b.trouble && areEqual(a.stance, b.stance) &&
         std::ranges::equal(
             a.steps, b.steps, [](const scripted::PlanStep& one, const scripted::PlanStep& other) {
               return one.kind == other.kind && one.base.position == other.base.position &&
                      one.base.yaw == other.base.yaw && one.from == other.from &&
                      one.joints == other.joints;
             });
}

/// The last state in which the policy has the target in its hand.
EnvState lastHeldState(const World& world) {
  BatchSimulator simulator = MemoryPack::opened(BatchSimulator::create(world, oneEnv()));
  ScriptedPolicy policy = MemoryPack::opened(ScriptedPolicy::create(world, oneEnv()));
  std::vector<float> actions(simulator.actionCount());
  EnvState held;
  while (simulator.dones()[0] == 0) {
    const EnvState state = simulator.envState(0);
    if (state.held >= 0) held = state;
    policy.act(simulator, actions);
    simulator.step(actions);
  }
  return held;
}

TEST(Planner, PlansTheSameWhateverItHasPlannedBefore) {
  const ScriptedWorld made = tableWorld();
  const World& world = made.world();
  const EnvState empty = MemoryPack::opened(BatchSimulator::create(world, oneEnv())).envState(0);
  const EnvState full = lastHeldState(world);
  ASSERT_EQ(full.held, static_cast<std::int32_t>(full.target));
  // The base stands where the arm reaches the target, too.
  EnvState opened = full;
  opened.held = -1;

  using MakePlan = std::function<Plan(Planner&)>;
  const std::vector<Stance> failed{Planner(world, oneEnv()).planPick(empty, {}).stance,
                                   Planner(world, oneEnv()).planPlace(full, {}).stance};
  const std::vector<MakePlan> makers{
      [&](Planner& planner) { return planner.planPick(empty, {}); },
      [&](Planner& planner) {
        return planner.planPlace(full, {1, failed});
      },
      [&](Planner& planner) { return planner.planPickFromHere(opened, {}, 0); },
      [&](Planner& planner) { return planner.planPlaceFromHere(full, {}, 1); },
      [&](Planner& planner) {
        return planner.planPick(empty, {1, failed});
      },
      [&](Planner& planner) { return planner.planPlace(full, {}); }};
  std::vector<Plan> fresh;
  for (const MakePlan& make : makers) {
    Planner planner(world, oneEnv());
    fresh.push_back(make(planner));
  }
  for (const Plan& plan : fresh) EXPECT_EQ(plan.trouble, ScriptedTrouble::kNone);
  EXPECT_FALSE(areEqual(fresh[0], fresh[4]));
  EXPECT_FALSE(areEqual(fresh[1], fresh[5]));

  Planner planner(world, oneEnv());
  for (std::size_t first = 0; first < makers.size(); ++first) {
    for (std::size_t then = 0; then < makers.size(); ++then) {
      (void)makers[first](planner);
      EXPECT_TRUE(areEqual(makers[then](planner), fresh[then])) << then << " after " << first;
    }
  }
}

TEST(Planner, KeepsItsWorld) {
  const ScriptedWorld made = tableWorld();
  const BatchSimulator simulator =
      MemoryPack::opened(BatchSimulator::create(made.world(), oneEnv()));
  auto world = std::make_unique<World>(made.world());
  Planner planner(*world, oneEnv());
  world.reset();
  const EnvState state = simulator.envState(0);
  EXPECT_EQ(planner.planPick(state, {}).trouble, ScriptedTrouble::kNone);
}

}  // namespace
}  // namespace galactic::test::planner_test
