#include "scripted/reach_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "support/random_stream.h"

namespace galactic::scripted {
namespace {

/// Chooses the samples; any other number would do.
constexpr std::uint64_t kSeed = 0x7265616368ULL;
/// An error in direction counts as much as this distance times the chord of its angle, meters.
constexpr float kDirectionWeight = 0.2F;

/// See ReachTable::bearing().
float meanBearing(std::span<const Pose> grips) {
  // A fraction of the mean distance: an arm that the robot can turn all the way round is near 0.
  constexpr float kOneSided = 0.2F;
  // Rounding removes the random scatter of the samples from the bearing of a symmetric arm.
  constexpr float kRounding = 0.392699082F;
  Vec3 sum;
  float distances = 0;
  for (const Pose& grip : grips) {
    const Vec3 away{grip.translation.x, 0, grip.translation.z};
    sum = sum + away;
    distances += std::sqrt(dot(away, away));
  }
  if (!(std::sqrt(dot(sum, sum)) > kOneSided * distances)) return 0;
  return kRounding * std::round(angleOf(-sum.z, sum.x) / kRounding);
}

}  // namespace

ReachTable::ReachTable(Arm& arm, const Joints& positions, std::uint32_t samples)
    : joints_(arm.joints().size()) {
  RandomStream random(kSeed, 0, 0, 0);
  Joints drawn = positions;
  rows_.reserve(samples * joints_);
  grips_.reserve(samples);
  for (std::uint32_t n = 0; n < samples; ++n) {
    arm.draw(random, drawn);
    const std::span<const Pose> links = arm.placeLinks(drawn);
    if (arm.touchesItself(links)) continue;
    grips_.push_back(arm.gripOf(links));
    for (const ArmJoint& joint : arm.joints()) rows_.push_back(drawn[joint.position]);
  }
  bearing_ = meanBearing(grips_);
  for (const Pose& grip : grips_) {
    farthest_ = std::max(farthest_, std::hypot(grip.translation.x, grip.translation.z));
  }
}

Joints ReachTable::joints(const Arm& arm, std::size_t n, const Joints& others) const {
  Joints result = others;
  for (std::size_t joint = 0; joint < joints_; ++joint) {
    result[arm.joints()[joint].position] = rows_[n * joints_ + joint];
  }
  return result;
}

ReachView::ReachView(const ReachTable& table, const Vec3& point, const Vec3& direction) {
  entries_.reserve(table.size());
  for (const Pose& grip : table.grips()) {
    entries_.push_back({grip * point, rotate(grip.rotation, direction)});
  }
}

std::size_t ReachView::nearest(const HandGoal& goal, float farthest,
                               std::span<std::uint32_t> out) const {
  constexpr std::size_t kMost = 8;
  std::array<float, kMost> costs{};
  const std::size_t room = std::min(out.size(), kMost);
  std::size_t count = 0;
  for (std::uint32_t n = 0; n < entries_.size(); ++n) {
    const Vec3 away = entries_[n].point - goal.place;
    const float squared = dot(away, away);
    if (squared > farthest * farthest) continue;
    const Vec3 turn = entries_[n].direction - goal.toward;
    const float cost = squared + kDirectionWeight * kDirectionWeight * dot(turn, turn);
    std::size_t at = count;
    while (at > 0 && cost < costs[at - 1]) --at;
    if (at >= room) continue;
    count = std::min(count + 1, room);
    for (std::size_t m = count - 1; m > at; --m) {
      costs[m] = costs[m - 1];
      out[m] = out[m - 1];
    }
    costs[at] = cost;
    out[at] = n;
  }
  return count;
}

}  // namespace galactic::scripted
