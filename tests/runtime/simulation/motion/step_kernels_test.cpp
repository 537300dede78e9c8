// What the kernels read, judge and observe, number by number; and their builds against each other.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include "simulation/motion/motion_kernels.h"
#include "support/oracles/resting_oracle.h"
#include "support/processor.h"

namespace galactic::test::step_kernels_test {
namespace {

using namespace galactic::simulation;

constexpr std::size_t kEnvs = kMostWidth;
constexpr int kRounds = 500;

/// The builds that this processor can run.
std::vector<MotionKernels> builds() {
  std::vector<MotionKernels> all{portableMotion()};
  if (detail::hasAvx2()) all.push_back(avx2Motion());
  if (detail::hasAvx512()) all.push_back(avx512Motion());
  return all;
}

std::vector<EnvRow> rowsOf(std::mt19937& random, std::size_t count) {
  std::vector<EnvRow> rows(count);
  for (EnvRow& row : rows) {
    for (float& value : row.values) value = uniformIn(random, -3, 3);
  }
  return rows;
}

template <class Values>
std::vector<std::uint32_t> bitsOf(const Values& values) {
  std::vector<std::uint32_t> bits(values.size() * sizeof(values[0]) / sizeof(std::uint32_t));
  std::memcpy(bits.data(), values.data(), values.size() * sizeof(values[0]));
  return bits;
}

/// Half of the batches are of eight envs, for which some builds have other code.
std::size_t envsOf(int round) { return round % 2 == 0 ? kEnvs : kLanes; }

float given(std::mt19937& random) {
  constexpr float kInfinite = std::numeric_limits<float>::infinity();
  constexpr std::array kSpecial{-0.0F, -1.0F, 1.0F, kInfinite, -kInfinite};
  const auto choice = random() % 16;
  return choice < kSpecial.size() ? kSpecial[choice] : uniformIn(random, -2, 2);
}

TEST(ReadKernel, CutsActionsAndFindsWhatIsNotANumber) {
  constexpr std::uint32_t kSeed = 521;
  std::printf("seed %u\n", kSeed);
  std::mt19937 random(kSeed);
  Tally has_nan;
  for (int round = 0; round < kRounds; ++round) {
    const std::size_t envs = envsOf(round);
    const std::size_t count = 4 + random() % 20;
    std::vector<float> actions(envs * count);
    for (float& action : actions) action = given(random);
    if (random() % 2 == 0) actions[random() % actions.size()] = std::nanf("");
    const auto is_nan = [](float value) { return std::isnan(value); };
    const bool any = std::ranges::any_of(actions, is_nan);
    has_nan.add(any);
    for (const MotionKernels& kernels : builds()) {
      std::vector<EnvRow> rows(count);
      const bool found = kernels.read({actions.data(), count, rows.front().values, envs});
      ASSERT_EQ(found, any);
      for (std::size_t n = 0; n < actions.size(); ++n) {
        const float wanted = is_nan(actions[n]) ? 0 : std::clamp(actions[n], -1.0F, 1.0F);
        ASSERT_EQ(std::bit_cast<std::uint32_t>(rows[n % count].values[n / count]),
                  std::bit_cast<std::uint32_t>(wanted));
      }
    }
  }
  has_nan.expectBothSides();
}

/// What a step is judged by, for random envs.
struct Judging {
  std::vector<EnvRow> actions, last, grips, targets, goals;
  std::array<std::uint32_t, kEnvs> active{};
  std::vector<EnvRow> results{3};

  Judging(std::mt19937& random, std::size_t joints)
      : actions(rowsOf(random, joints)),
        last(rowsOf(random, joints)),
        grips(rowsOf(random, kGripNumbers)),
        targets(rowsOf(random, 3)),
        goals(rowsOf(random, 3)) {
    for (std::uint32_t& lane : active) lane = random() % 2 == 0 ? 0 : ~std::uint32_t{0};
  }

  void judge(const MotionKernels& kernels, std::size_t envs) {
    // There may be no joints.
    const bool has_joints = !actions.empty();
    kernels.judge({.actions = has_joints ? actions.front().values : nullptr,
                   .last_actions = has_joints ? last.front().values : nullptr,
                   .active = active.data(),
                   .joints = actions.size(),
                   .grips = grips.data()->values,
                   .targets = targets.data()->values,
                   .goals = goals.data()->values,
                   .change = results[0].values,
                   .reach = results[1].values,
                   .transport = results[2].values,
                   .envs = envs});
  }
};

float distance(const EnvRow* from, const EnvRow* to, std::size_t env) {
  float squared = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    const float away = from[c].values[env] - to[c].values[env];
    squared += away * away;
  }
  return std::sqrt(squared);
}

void expectJudged(const Judging& before, const Judging& after, std::size_t env) {
  float change = 0;
  for (std::size_t n = 0; n < before.actions.size(); ++n) {
    const float action = before.actions[n].values[env];
    const float last = before.last[n].values[env];
    change += (action - last) * (action - last);
    ASSERT_EQ(after.last[n].values[env], before.active[env] != 0 ? action : last);
  }
  ASSERT_EQ(after.results[0].values[env], change);
  ASSERT_EQ(after.results[1].values[env],
            distance(before.grips.data() + 9, before.targets.data(), env));
  ASSERT_EQ(after.results[2].values[env],
            distance(before.targets.data(), before.goals.data(), env));
}

TEST(JudgeKernel, MeasuresChangesAndDistances) {
  constexpr std::uint32_t kSeed = 522;
  std::printf("seed %u\n", kSeed);
  std::mt19937 random(kSeed);
  for (int round = 0; round < kRounds; ++round) {
    const std::size_t envs = envsOf(round);
    const Judging before(random, random() % 12);
    for (const MotionKernels& kernels : builds()) {
      Judging after = before;
      after.judge(kernels, envs);
      for (std::size_t env = 0; env < envs; ++env) expectJudged(before, after, env);
    }
  }
}

TEST(ShiftKernel, MovesSpheresAndBoundsOfOneCandidate) {
  constexpr std::uint32_t kSeed = 524;
  std::printf("seed %u\n", kSeed);
  std::mt19937 random(kSeed);
  constexpr std::size_t kSpheres = 5 * kLanes;
  for (int round = 0; round < kRounds; ++round) {
    std::vector<float> numbers(3 * kSpheres + kBounds * kLanes + kLanes);
    for (float& number : numbers) number = uniformIn(random, -3, 3);
    const std::array<float, 3> by{uniformIn(random, -1, 1),
                                  round % 2 == 0 ? 0 : uniformIn(random, -1, 1),
                                  uniformIn(random, -1, 1)};
    std::vector<float> wanted = numbers;
    for (std::size_t n = 0; n < 3 * kSpheres; ++n) wanted[n] += by[n / kSpheres];
    float* bounds = wanted.data() + 3 * kSpheres;
    for (std::size_t n = 0; n < kBounds * kLanes; ++n) bounds[n] += by[n / (2 * kLanes)];
    for (std::size_t n = 0; n < kBounds; ++n) bounds[kBounds * kLanes + n] += by[n / 2];
    for (const MotionKernels& kernels : builds()) {
      std::vector<float> moved = numbers;
      float* moved_bounds = moved.data() + 3 * kSpheres;
      kernels.shift({.by_x = by[0],
                     .by_y = by[1],
                     .by_z = by[2],
                     .centers = moved.data(),
                     .sphere_count = kSpheres,
                     .bounds = moved_bounds,
                     .group_count = kLanes,
                     .extents = moved_bounds + kBounds * kLanes});
      ASSERT_EQ(moved, wanted);
    }
  }
}

TEST(ShiftKernel, MovesTheFramesOfAllEnvs) {
  constexpr std::uint32_t kSeed = 525;
  std::printf("seed %u\n", kSeed);
  std::mt19937 random(kSeed);
  for (int round = 0; round < kRounds; ++round) {
    const std::size_t envs = envsOf(round);
    const std::vector<EnvRow> before = rowsOf(random, kFrameNumbers * (1 + random() % 14));
    const std::vector<EnvRow> by = rowsOf(random, 3);
    for (const MotionKernels& kernels : builds()) {
      std::vector<EnvRow> moved = before;
      kernels.shift_frames({moved.front().values, moved.size(), by.front().values, envs});
      for (std::size_t n = 0; n < before.size(); ++n) {
        const std::size_t number = n % kFrameNumbers;
        for (std::size_t env = 0; env < envs; ++env) {
          const float shift = number < 9 ? 0 : by[number - 9].values[env];
          ASSERT_EQ(moved[n].values[env], before[n].values[env] + shift);
        }
      }
    }
  }
}

TEST(ObserveKernel, WritesTheSameBitsInAllBuilds) {
  constexpr std::uint32_t kSeed = 523;
  std::printf("seed %u\n", kSeed);
  std::mt19937 random(kSeed);
  for (int round = 0; round < kRounds; ++round) {
    constexpr std::size_t kVariables = 20;
    std::vector<EnvRow> pose = rowsOf(random, 4 + kVariables);
    const std::vector<EnvRow> rows = rowsOf(random, kGripNumbers + 12);
    std::vector<std::uint32_t> controlled(random() % kVariables);
    for (std::uint32_t& variable : controlled) {
      variable = static_cast<std::uint32_t>(random() % kVariables);
    }
    const auto row = [&rows](std::size_t n) { return rows[n].values; };
    const std::size_t most = 16 + kVariables + 3 + 1 + 3;
    std::vector<float> first;
    const bool bump = random() % 2 == 0;
    const bool target_goal = random() % 2 == 0;
    for (const MotionKernels& kernels : builds()) {
      std::vector<float> out(kEnvs * most);
      kernels.observe({.pose = {pose[0].values, pose[1].values, pose[2].values, pose[3].values,
                                pose[4].values, kMostWidth},
                       .controlled = controlled.data(),
                       .controlled_count = controlled.size(),
                       .grips = row(0),
                       .targets = row(kGripNumbers),
                       .current_targets = row(kGripNumbers + 3),
                       .goals = row(kGripNumbers + 6),
                       .holds = row(kGripNumbers + 9),
                       .left = row(kGripNumbers + 10),
                       .bumps = row(kGripNumbers + 11),
                       .observes_bump = bump,
                       .observes_target_goal = target_goal,
                       .out = out.data(),
                       .out_stride = most,
                       .envs = envsOf(round)});
      if (first.empty()) first = out;
      ASSERT_EQ(bitsOf(out), bitsOf(first));
      // What stays as it is: nothing is written behind an env's own numbers.
      const std::size_t size = 16 + controlled.size() + 3 + (bump ? 1 : 0) + (target_goal ? 3 : 0);
      ASSERT_EQ(out[15], row(kGripNumbers + 9)[0]);
      for (std::size_t n = size; n < most; ++n) ASSERT_EQ(out[n], 0);
      for (std::size_t n = 0; n < controlled.size(); ++n) {
        ASSERT_EQ(out[most + 16 + n], pose[4 + controlled[n]].values[1]);
      }
    }
  }
}

}  // namespace
}  // namespace galactic::test::step_kernels_test
