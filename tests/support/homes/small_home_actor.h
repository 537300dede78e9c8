#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <span>

#include "galactic/batch_simulator.h"
#include "support/homes/small_home.h"
#include "support/oracles/task_oracle.h"

namespace galactic::test {

using SmallHomeRow = std::array<float, kSmallHomeActions>;

/// Arm actions that bring the small home's grip towards a point in the world, wrist straight. The
/// hand stays as it is: closed when it holds something.
inline SmallHomeRow reachTowards(const EnvState& s, const Vec3& point) {
  constexpr double kTurn = 6.283185307179586;
  const auto clamped = [](double value) {
    return static_cast<float>(std::clamp(value, -1.0, 1.0));
  };
  const Double3 away = difference(double3(point), double3(s.world_from_root.translation));
  const Quat& q = s.world_from_root.rotation;
  const double yaw = 2 * std::atan2(static_cast<double>(q.y), static_cast<double>(q.w));
  const auto position = [&](SmallHomeAction joint) {
    return static_cast<double>(s.joint_positions[joint]);
  };
  const double wanted = std::atan2(-away[2], away[0]) - yaw;
  constexpr double kGripAhead = 0.37;
  SmallHomeRow row{};
  row[kLift] = clamped(static_cast<double>(point.y - s.world_from_grip.translation.y) / 0.05);
  row[kShoulder] = clamped(std::remainder(wanted - position(kShoulder), kTurn) / 0.1);
  row[kArm] = clamped((std::hypot(away[0], away[2]) - kGripAhead - position(kArm)) / 0.05);
  row[kWrist] = clamped(-position(kWrist) / 0.1);
  row[kHand] = s.held >= 0 ? 1.0F : 0.0F;
  return row;
}

/// Horizontal distance.
inline double aside(const Vec3& a, const Vec3& b) {
  return std::hypot(static_cast<double>(a.x - b.x), static_cast<double>(a.z - b.z));
}

/// From above down to the object `number`; grasps when it is close.
inline SmallHomeRow fetch(const EnvState& s, std::size_t number) {
  Vec3 point = s.objects[number].translation;
  constexpr float kMiddle = 0.05F;
  constexpr float kAbove = 0.2F;
  point.y += aside(s.world_from_grip.translation, point) > 0.03 ? kAbove : kMiddle;
  SmallHomeRow row = reachTowards(s, point);
  constexpr double kClose = 0.12;
  if (distance(s.world_from_grip.translation, s.objects[number].translation) < kClose) {
    row[kHand] = 1;
  }
  return row;
}

/// Brings what is held over a place, then down to it.
inline SmallHomeRow carry(const EnvState& s, const Vec3& place) {
  const Vec3& held = s.objects[static_cast<std::size_t>(s.held)].translation;
  Vec3 to = place;
  constexpr float kAbove = 0.15F;
  constexpr float kLow = 0.02F;
  to.y += aside(held, place) > 0.03 ? kAbove : kLow;
  return reachTowards(s, s.world_from_grip.translation + (to - held));
}

/// The whole Rearrange task, step by step.
inline SmallHomeRow solve(const EnvState& s) {
  constexpr double kThere = 0.06;
  const bool is_there = TaskOracle::transportOf(s) < kThere;
  if (s.held == static_cast<std::int32_t>(s.target)) {
    SmallHomeRow row = carry(s, s.goal.translation);
    if (is_there) row[kHand] = -1;
    return row;
  }
  SmallHomeRow row{};
  if (is_there) {
    row[kTerminate] = 1;
    return row;
  }
  return fetch(s, s.target);
}

/// Acts in all ways that a task has rules for: each episode at random, or solving it, or fetching
/// another object, or letting go on the way, or terminating on the way; with noise, values out of
/// range and NaN among them.
class WildActor {
 public:
  explicit WildActor(std::uint32_t seed) : random_(seed) { begin(); }

  void begin() { mode_ = static_cast<Mode>(random_() % kModes); }

  [[nodiscard]] SmallHomeRow act(const EnvState& s) {
    SmallHomeRow row{};
    if (mode_ == kAtRandom) {
      for (float& action : row) action = symmetric();
      row[kTerminate] = chance(0.01) ? 1.0F : 0.0F;
      return row;
    }
    row = mode_ == kAnother && s.held < 0 ? fetch(s, (s.target + 1) % s.objects.size()) : solve(s);
    if (mode_ == kLetsGo && s.held >= 0 && chance(0.1)) row[kHand] = -1;
    if (mode_ == kStops && chance(0.03)) row[kTerminate] = 1;
    for (float& action : std::span(row).first(kHand)) action += 0.05F * symmetric();
    if (chance(0.02)) row[random_() % kHand] = 5 * symmetric();
    if (chance(0.01)) row[random_() % kHand] = std::numeric_limits<float>::quiet_NaN();
    return row;
  }

 private:
  enum Mode : std::uint32_t { kAtRandom, kSolves, kAnother, kLetsGo, kStops, kModes };

  float symmetric() { return static_cast<float>(random_()) * 0x1p-31F - 1; }
  bool chance(double share) { return static_cast<double>(random_()) * 0x1p-32 < share; }

  std::mt19937 random_;
  Mode mode_ = kAtRandom;
};

}  // namespace galactic::test
