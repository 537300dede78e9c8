// States of envs: saved, restored, and gone on from; and bytes that are none.
#define XXH_INLINE_ALL
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <xxhash.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "runtime/simulation/batch_trace.h"
#include "support/homes/every_option.h"
#include "support/homes/small_home_actor.h"
#include "support/homes/task_twins.h"

namespace galactic::test::saved_state_test {
namespace {

using testing::HasSubstr;
using Bytes = std::vector<std::byte>;

constexpr std::uint32_t kSeed = 5150;
constexpr std::size_t kHeaderBytes = 64;

SimulationOptions homeOptions(std::uint32_t envs, std::uint32_t threads = 1) {
  SimulationOptions options;
  options.envs = envs;
  options.threads = threads;
  options.seed = 3;
  options.task = everyReward();
  options.sensors = everySensor();
  options.noise = {
      .motion = 0.1F, .motion_bias = 0.1F, .localization = 0.1F, .action_delay = {0, 2}};
  return options;
}

/// Steps simulators of the small home alike, with actors that grasp, carry, drop and terminate.
class WildRun {
 public:
  explicit WildRun(std::uint32_t envs) : actions_(envs * kSmallHomeActions) {
    for (std::uint32_t env = 0; env < envs; ++env) actors_.emplace_back(kSeed + env);
  }

  /// Actions for the state of `simulator`.
  const std::vector<float>& act(const BatchSimulator& simulator) {
    for (std::size_t env = 0; env < actors_.size(); ++env) {
      if (simulator.dones()[env] != 0) actors_[env].begin();
      const SmallHomeRow row = actors_[env].act(simulator.envState(env));
      std::ranges::copy(row, actions_.begin() + static_cast<std::ptrdiff_t>(env * row.size()));
    }
    return actions_;
  }

 private:
  std::vector<WildActor> actors_;
  std::vector<float> actions_;
};

std::vector<std::uint64_t> traceOf(const BatchSimulator& simulator) {
  return BatchTrace(simulator).hashes();
}

void expectSameStatistics(const SimulationStatistics& a, const SimulationStatistics& b) {
  visitStatistics([&](const char* name, auto member) { EXPECT_EQ(a.*member, b.*member) << name; });
}

TEST(SavedState, GoesOnBitForBitInTheSameAndInOtherSimulators) {
  const SmallHome home;
  constexpr std::uint32_t kEnvs = 37;
  for (const bool bodies : {false, true}) {
    SimulationOptions options = homeOptions(kEnvs);
    options.body_transforms = bodies;
    BatchSimulator first = simulatorOf(home.world(), options);
    WildRun run(kEnvs);
    const auto is_held = [&] {
      int count = 0;
      for (std::size_t env = 0; env < kEnvs; ++env) count += first.envState(env).held >= 0 ? 1 : 0;
      return count;
    };
    for (int step = 0; step < 70 || is_held() < 5; ++step) first.step(run.act(first));
    const int held = is_held();
    EXPECT_GE(held, 5);
    EXPECT_LE(held, static_cast<int>(kEnvs) - 5);
    const Bytes saved = first.saveState();
    options.threads = 2;
    options.seed = 77;  // The state brings its own.
    BatchSimulator second = simulatorOf(home.world(), options);
    second.step(std::vector<float>(kEnvs * kSmallHomeActions, 1.0F));
    ASSERT_TRUE(second.restoreState(saved));
    EXPECT_EQ(second.saveState(), saved);
    EXPECT_EQ(traceOf(second), traceOf(first));
    std::vector<std::vector<float>> played;
    std::vector<std::vector<std::uint64_t>> seen;
    for (int step = 0; step < 500; ++step) {
      played.push_back(run.act(first));
      first.step(played.back());
      second.step(played.back());
      seen.push_back(traceOf(first));
      ASSERT_EQ(traceOf(second), seen.back()) << "step " << step;
    }
    expectSameStatistics(second.statistics(), first.statistics());
    EXPECT_GT(first.statistics().drops, 20U);
    EXPECT_GT(first.statistics().episodes, 200U);
    EXPECT_GT(first.statistics().picks, 50U);
    EXPECT_LT(first.statistics().picks, first.statistics().episodes - 50);
    // And back in the simulator that saved it.
    ASSERT_TRUE(first.restoreState(saved));
    for (std::size_t step = 0; step < played.size(); ++step) {
      first.step(played[step]);
      ASSERT_EQ(traceOf(first), seen[step]) << "step " << step;
    }
  }
}

TEST(SavedState, OfOneEnvIsPutIntoAllThatAreChosen) {
  const SmallHome home;
  constexpr std::uint32_t kEnvs = 20;
  BatchSimulator batch = simulatorOf(home.world(), homeOptions(kEnvs));
  WildRun run(kEnvs);
  for (int step = 0; step < 45; ++step) batch.step(run.act(batch));
  const Bytes of_17 = batch.saveState(std::vector<std::uint32_t>{17});
  const EnvState untouched = batch.envState(5);
  ASSERT_TRUE(batch.restoreState(of_17, std::vector<std::uint32_t>{0, 19, 4}));
  for (const std::size_t env : {0U, 19U, 4U}) {
    expectSameState(batch.envState(env), batch.envState(17));
  }
  expectSameState(batch.envState(5), untouched);
  // Without a choice, into all, with its seed.
  SimulationOptions others = homeOptions(7);
  others.seed = 77;
  BatchSimulator planner = simulatorOf(home.world(), others);
  ASSERT_TRUE(planner.restoreState(of_17));
  for (std::size_t env = 0; env < 7; ++env) {
    expectSameState(planner.envState(env), batch.envState(17));
  }
  const Bytes of_two = batch.saveState(std::vector<std::uint32_t>{17, 2});
  // One of them alone.
  ASSERT_TRUE(batch.restoreState(of_two, std::vector<std::uint32_t>{BatchSimulator::kNoEnv, 6}));
  expectSameState(batch.envState(6), batch.envState(2));
  const Result<void> refused = planner.restoreState(of_two);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message,
              HasSubstr("has 2 envs, expected 7, or one that becomes all of them"));
}

TEST(SavedState, OfChosenEnvsIsPutIntoChosenEnvs) {
  const SmallHome home;
  constexpr std::uint32_t kEnvs = 20;
  BatchSimulator batch = simulatorOf(home.world(), homeOptions(kEnvs));
  WildRun run(kEnvs);
  for (int step = 0; step < 45; ++step) batch.step(run.act(batch));
  const std::vector<std::uint32_t> chosen{17, 2};
  const Bytes saved = batch.saveState(chosen);
  // One env, with the number over all ranks that env 17 had, does what env 17 does.
  SimulationOptions alone = homeOptions(1);
  alone.ranks = kEnvs;
  alone.rank = 17;
  BatchSimulator single = simulatorOf(home.world(), alone);
  const Bytes of_17 = batch.saveState(std::vector<std::uint32_t>{17});
  ASSERT_TRUE(single.restoreState(of_17, std::vector<std::uint32_t>{0}));
  // Planning: the same two states again and again, here in other envs.
  const std::vector<std::uint32_t> places{4, 19};
  const EnvState untouched = batch.envState(5);
  ASSERT_TRUE(batch.restoreState(saved, places));
  expectSameState(batch.envState(4), batch.envState(17));
  expectSameState(batch.envState(19), batch.envState(2));
  expectSameState(batch.envState(5), untouched);
  for (int step = 0; step < 200; ++step) {
    const std::vector<float>& actions = run.act(batch);
    const std::size_t first = 17 * kSmallHomeActions;
    single.step(std::span(actions).subspan(first, kSmallHomeActions));
    batch.step(actions);
    ASSERT_EQ(traceOf(single)[0], traceOf(batch)[17]);
  }
}

/// The state's header says that it is what it is.
void sign(Bytes& state) {
  constexpr std::size_t kHashAt = 56;
  std::uint64_t hash = 0;
  std::memcpy(state.data() + kHashAt, &hash, sizeof(hash));
  hash = XXH3_64bits(state.data(), state.size());
  std::memcpy(state.data() + kHashAt, &hash, sizeof(hash));
}

std::string refusalOf(BatchSimulator& simulator, const Bytes& state) {
  const Result<void> restored = simulator.restoreState(state);
  return restored ? "" : restored.error().where + " " + restored.error().message;
}

class DamagedState : public testing::Test {
 protected:
  DamagedState() : simulator_(simulatorOf(home_.world(), homeOptions(3))) {
    WildRun run(3);
    for (int step = 0; step < 40; ++step) simulator_.step(run.act(simulator_));
    state_ = simulator_.saveState();
    trace_ = traceOf(simulator_);
  }

  /// A refusal, after which everything is as it was.
  void expectRefused(const Bytes& state, const std::string& why) {
    EXPECT_THAT(refusalOf(simulator_, state), HasSubstr(why));
    EXPECT_EQ(traceOf(simulator_), trace_);
  }

  SmallHome home_;
  BatchSimulator simulator_;
  Bytes state_;
  std::vector<std::uint64_t> trace_;
};

TEST_F(DamagedState, IsRefusedAtEachLength) {
  for (std::size_t length = 0; length < state_.size(); ++length) {
    Bytes cut(state_.begin(), state_.begin() + static_cast<std::ptrdiff_t>(length));
    ASSERT_NE(refusalOf(simulator_, cut), "") << length;
    if (length < kHeaderBytes) continue;
    sign(cut);
    ASSERT_NE(refusalOf(simulator_, cut), "") << length;
  }
  state_.push_back(std::byte{0});
  sign(state_);
  expectRefused(state_, "goes on behind its last env");
}

TEST_F(DamagedState, IsRefusedForEachFlippedBit) {
  for (std::size_t bit = 0; bit < 8 * state_.size(); ++bit) {
    Bytes flipped = state_;
    flipped[bit / 8] ^= std::byte{1} << (bit % 8);
    ASSERT_NE(refusalOf(simulator_, flipped), "") << bit;
  }
  EXPECT_EQ(traceOf(simulator_), trace_);
}

TEST_F(DamagedState, WithARightHashIsRefusedOrSteps) {
  constexpr std::array<std::uint32_t, 6> kWords{0,          1,          0xFFFFFFFF,
                                                0x7FC00000, 0x7F7FFFFF, 0x49742400};
  int refused = 0;
  int taken = 0;
  std::mt19937 random(kSeed);
  for (std::size_t at = kHeaderBytes; at + 4 <= state_.size(); at += 4) {
    for (const std::uint32_t word : kWords) {
      Bytes changed = state_;
      std::memcpy(changed.data() + at, &word, sizeof(word));
      sign(changed);
      if (!simulator_.restoreState(changed)) {
        ++refused;
        continue;
      }
      ++taken;
      for (std::uint32_t step = 0; step < 3; ++step) {
        std::vector<float> actions(3 * kSmallHomeActions);
        for (float& action : actions) action = static_cast<float>(random()) * 0x1p-31F - 1;
        simulator_.step(actions);
      }
    }
  }
  std::printf("seed %u: %d refused, %d taken\n", kSeed, refused, taken);
  EXPECT_GT(10 * refused, refused + taken);
  EXPECT_GT(10 * taken, refused + taken);
}

TEST_F(DamagedState, IsRefusedWithWhatIsWrong) {
  expectRefused({}, "is none; give what saving a state returned");
  Bytes other = state_;
  other[0] = std::byte{'g'};
  expectRefused(other, "is none");
  other = state_;
  other[8] = std::byte{8};
  expectRefused(other, "has format version 8, expected 9; use the version that saved it");
  other = state_;
  other[40] ^= std::byte{1};
  sign(other);
  expectRefused(other, "is of another world");
  const Bytes two = simulator_.saveState(std::vector<std::uint32_t>{0, 1});
  expectRefused(two, "has 2 envs, expected 3");
}

/// The same without the line of an option, as a version saved it that did not have it.
Bytes without(const Bytes& state, const std::string& line) {
  constexpr std::size_t kOptionBytesAt = 16;
  Bytes older = state;
  const auto* text = reinterpret_cast<const std::byte*>(line.data());
  const auto found = std::search(older.begin(), older.end(), text, text + line.size());
  EXPECT_NE(found, older.end()) << line;
  older.erase(found, found + static_cast<std::ptrdiff_t>(line.size()));
  std::uint32_t option_bytes = 0;
  std::memcpy(&option_bytes, older.data() + kOptionBytesAt, sizeof(option_bytes));
  option_bytes -= static_cast<std::uint32_t>(line.size());
  std::memcpy(older.data() + kOptionBytesAt, &option_bytes, sizeof(option_bytes));
  sign(older);
  return older;
}

TEST(SavedState, OfAVersionThatHadFewerOptionsIsTakenWhereTheyAreOff) {
  const SmallHome home;
  SimulationOptions options = homeOptions(3);
  options.noise.action_delay = 0;
  BatchSimulator simulator = simulatorOf(home.world(), options);
  WildRun run(3);
  for (int step = 0; step < 40; ++step) simulator.step(run.act(simulator));
  const Bytes state = simulator.saveState();
  const std::vector<std::uint64_t> trace = traceOf(simulator);
  const Bytes older = without(state, "action-delay=0\n");
  for (int step = 0; step < 5; ++step) simulator.step(run.act(simulator));
  EXPECT_EQ(refusalOf(simulator, older), "");
  EXPECT_EQ(traceOf(simulator), trace);
  EXPECT_EQ(simulator.saveState(), state);
  // Not where it is on, nor where the state lacks one that the simulator has changed.
  options.noise.action_delay = 2;
  BatchSimulator late = simulatorOf(home.world(), options);
  EXPECT_THAT(
      refusalOf(late, older),
      HasSubstr("no option action-delay: restore it where that is 0, as by default, instead of 2"));
  EXPECT_THAT(refusalOf(simulator, without(state, "motion-noise=0.1\n")),
              HasSubstr("no option motion-noise: restore it where that is 0"));
}

/// Of the numbers of an env.
constexpr std::size_t kRecordBytes = 248;

/// Where the numbers of the first env of a state end: the last eight bytes are those of picks.
std::ptrdiff_t endOfNumbers(const Bytes& state) {
  constexpr std::size_t kOptionBytesAt = 16;
  std::uint32_t option_bytes = 0;
  std::memcpy(&option_bytes, state.data() + kOptionBytesAt, sizeof(option_bytes));
  return static_cast<std::ptrdiff_t>(kHeaderBytes + option_bytes + kRecordBytes);
}

TEST_F(DamagedState, WithActionsThatNobodyAskedForIsRefused) {
  // NaN stands for what hands and terminations are asked before an episode, and for no other
  // action.
  constexpr float kAsked = 0.40625F;
  const auto with = [&](std::size_t action, float instead) {
    SmallHomeRow row{};
    row[action] = kAsked;
    std::vector<float> actions;
    for (int env = 0; env < 3; ++env) actions.insert(actions.end(), row.begin(), row.end());
    simulator_.step(actions);
    trace_ = traceOf(simulator_);
    Bytes changed = simulator_.saveState();
    const auto asked = std::as_bytes(std::span(&kAsked, 1));
    // The last one: of this step.
    const auto found = std::find_end(changed.begin(), changed.end(), asked.begin(), asked.end());
    EXPECT_NE(found, changed.end());
    std::memcpy(&*found, &instead, sizeof(instead));
    sign(changed);
    return changed;
  };
  const std::string why = "has a number that no simulation leaves; it is damaged";
  expectRefused(with(kForward, 1.25F), why);
  expectRefused(with(kForward, std::nanf("")), why);
  expectRefused(with(kHand, -1.25F), why);
  EXPECT_EQ(refusalOf(simulator_, with(kHand, std::nanf(""))), "");
}

TEST_F(DamagedState, WithAPickOfNoEndIsRefused) {
  ASSERT_EQ(simulator_.dones()[0], 0);
  Bytes other = state_;
  other[static_cast<std::size_t>(endOfNumbers(other)) - 4] = std::byte{1};
  sign(other);
  expectRefused(other, "env 0 has a wrong flag or count");
}

TEST_F(DamagedState, AfterMoreStepsThanAnEpisodeHasIsRefused) {
  constexpr std::size_t kStepAt = 44;
  const std::size_t at = static_cast<std::size_t>(endOfNumbers(state_)) - kRecordBytes + kStepAt;
  std::uint32_t step = 0;
  std::memcpy(&step, state_.data() + at, sizeof(step));
  ASSERT_EQ(step, simulator_.envState(0).step);
  const std::uint32_t most = simulator_.options().task.most_steps;
  ASSERT_GT(most, 0U);
  const auto with = [&](std::uint32_t instead) {
    Bytes changed = state_;
    std::memcpy(changed.data() + at, &instead, sizeof(instead));
    sign(changed);
    return changed;
  };
  expectRefused(with(most + 1), fmt::format("env 0 is after {} steps, and an episode has {}; "
                                            "it is damaged",
                                            most + 1, most));
  EXPECT_EQ(refusalOf(simulator_, with(most)), "");
  EXPECT_EQ(simulator_.envState(0).step, most);
}

TEST_F(DamagedState, ThatLeavesWhatItHoldsIsRefused) {
  WildRun run(3);
  std::uint32_t env = 3;
  for (int step = 0; step < 400 && env == 3; ++step) {
    simulator_.step(run.act(simulator_));
    for (std::uint32_t n = 0; n < 3; ++n) {
      if (simulator_.envState(n).held >= 0 && simulator_.dones()[n] == 0) env = n;
    }
  }
  ASSERT_LT(env, 3U) << "no hand holds anything";
  trace_ = traceOf(simulator_);
  const std::vector<std::uint32_t> alone{env};
  const EnvState now = simulator_.envState(env);
  Bytes state = simulator_.saveState(alone);
  // At the end are the objects, and before them the spheres of the robot that leave each of them:
  // as bits, in one word.
  const std::size_t leaving =
      state.size() - now.objects.size() * (sizeof(Pose) + sizeof(std::uint64_t));
  const auto set = [&](std::size_t at, auto value) {
    std::memcpy(state.data() + at, &value, sizeof(value));
  };
  // How many objects the robot leaves stands so many bytes before the end of the env's numbers.
  constexpr std::size_t kLeftIsBeforeTheEnd = 196;
  set(leaving + static_cast<std::size_t>(now.held) * sizeof(std::uint64_t), std::uint64_t{1});
  set(static_cast<std::size_t>(endOfNumbers(state)) - kLeftIsBeforeTheEnd, std::uint32_t{1});
  sign(state);
  const Result<void> restored = simulator_.restoreState(state, alone);
  ASSERT_FALSE(restored);
  EXPECT_THAT(restored.error().message, HasSubstr("leaves other objects than it says"));
}

TEST_F(DamagedState, OfOtherOptionsIsRefusedByTheirNames) {
  SimulationOptions options = homeOptions(3);
  options.task.success_distance = 0.5F;
  BatchSimulator far = simulatorOf(home_.world(), options);
  EXPECT_THAT(refusalOf(far, state_), HasSubstr("expected success-distance=0.5, found "
                                                "success-distance=0.25"));
}

TEST(SavedState, GoesOnWhereEpisodesBeginByThemselvesAndWhereTheyWait) {
  const SmallHome home;
  SimulationOptions options = homeOptions(6);
  options.task.most_steps = 30;
  BatchSimulator goes_on = simulatorOf(home.world(), options);
  options.auto_reset = false;
  BatchSimulator waits = simulatorOf(home.world(), options);
  WildRun run(6);
  // Until they are out of time.
  const auto motions = [&run, &waits] {
    std::vector<float> actions = run.act(waits);
    for (std::size_t n = 0; n < actions.size(); ++n) {
      if (n % kSmallHomeActions >= waits.actionLayout().movingCount()) actions[n] = 0;
    }
    return actions;
  };
  for (int step = 0; step < 20; ++step) waits.step(motions());
  ASSERT_TRUE(goes_on.restoreState(waits.saveState()));
  for (int step = 0; step < 10; ++step) {
    ASSERT_EQ(traceOf(goes_on), traceOf(waits)) << "step " << step;
    const std::vector<float> actions = motions();
    waits.step(actions);
    goes_on.step(actions);
  }
  EXPECT_EQ(goes_on.dones()[0], 1);
  // Who waits there would wait here for ever.
  const Result<void> restored = goes_on.restoreState(waits.saveState());
  ASSERT_FALSE(restored);
  EXPECT_EQ(
      restored.error().message,
      "env 0 waits where its episode ended, which envs with auto_reset do not; begin its next "
      "episode before you save it");
  // The other way round, the next episode has begun.
  ASSERT_TRUE(waits.restoreState(goes_on.saveState()));
  const std::vector<float> actions = motions();
  waits.step(actions);
  goes_on.step(actions);
  EXPECT_EQ(waits.envState(0).step, 1U);
  EXPECT_EQ(waits.envState(0).joint_positions, goes_on.envState(0).joint_positions);
}

TEST(SavedState, HasBodiesWhereTheyAreWantedAndWereNotSaved) {
  const SmallHome home;
  constexpr std::uint32_t kEnvs = 20;
  SimulationOptions options = homeOptions(kEnvs);
  BatchSimulator plain = simulatorOf(home.world(), options);
  options.body_transforms = true;
  BatchSimulator drawn = simulatorOf(home.world(), options);
  WildRun run(kEnvs);
  for (int step = 0; step < 60; ++step) {
    const std::vector<float> actions = run.act(plain);
    plain.step(actions);
    drawn.step(actions);
  }
  const std::vector<RigidTransform> wanted(drawn.bodyTransforms().begin(),
                                           drawn.bodyTransforms().end());
  drawn.restart(3);
  ASSERT_TRUE(drawn.restoreState(plain.saveState()));
  // Robots that slid were moved with their bodies.
  constexpr float kRounding = 1e-5F;
  for (std::size_t n = 0; n < wanted.size(); ++n) {
    const RigidTransform& found = drawn.bodyTransforms()[n];
    const Vec3 off = found.origin - wanted[n].origin;
    const Vec3 turned = found.x_axis - wanted[n].x_axis;
    ASSERT_LT(std::hypot(off.x, off.y, off.z) + std::hypot(turned.x, turned.y, turned.z), kRounding)
        << "body " << n;
  }
  // The other way round, they are left out.
  EXPECT_TRUE(plain.restoreState(drawn.saveState()));
}

TEST_F(DamagedState, OfAnotherSeedIsRefusedWhereItIsOnlyAPart) {
  const Bytes one = simulator_.saveState(std::vector<std::uint32_t>{0});
  simulator_.restart(8);
  const Result<void> restored = simulator_.restoreState(one, std::vector<std::uint32_t>{2});
  ASSERT_FALSE(restored);
  EXPECT_THAT(restored.error().message, HasSubstr("saved with seed 3, and the simulator has 8"));
}

}  // namespace
}  // namespace galactic::test::saved_state_test
