#include "scripted/carries.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace galactic::scripted {

std::vector<Joints> chooseCarries(PlanningScene& scene, Arm& arm, const ReachTable& table) {
  // Room for a held object, meters, and how much farther out the start pose may reach and still be
  // kept, because the robot's maker chose it.
  constexpr float kHeldRoom = 0.15F;
  constexpr float kStartBonus = 1.15F;
  constexpr float kLowest = 0.4F;
  constexpr float kHighest = 1.4F;
  constexpr std::size_t kMostCarries = 3;
  constexpr float kApart = 0.3F;
  Joints start{arm.robot().startPositions().begin(), arm.robot().startPositions().end()};
  for (const ArmJoint& joint : arm.joints()) {
    start[joint.position] = std::clamp(start[joint.position], joint.lower, joint.upper);
  }
  const auto reach_of = [&](const Joints& joints, const Pose& grip) {
    scene.setJoints(joints);
    const Vec3& p = grip.translation;
    return std::max(scene.reach(), std::sqrt(p.x * p.x + p.z * p.z) + kHeldRoom);
  };
  struct Candidate {
    float reach = 0;
    std::size_t sample = 0;
  };
  const Vec3 side = headingOf(table.bearing());
  std::vector<Candidate> candidates;
  candidates.reserve(table.size());
  for (std::size_t n = 0; n < table.size(); ++n) {
    const Pose& grip = table.grips()[n];
    const Vec3& p = grip.translation;
    // In front, where the robot sees what it holds, or on the side on which the arm reaches.
    const float out = dot(p, side);
    const bool is_beside = out >= std::fabs(p.x * side.z - p.z * side.x);
    if (p.y < kLowest || p.y > kHighest || (p.x < std::fabs(p.z) && !is_beside)) continue;
    candidates.push_back({reach_of(table.joints(arm, n, start), grip), n});
  }
  std::ranges::stable_sort(candidates, {}, &Candidate::reach);
  const Pose start_grip = arm.gripOf(arm.placeLinks(start));
  const bool start_is_good =
      candidates.empty() || reach_of(start, start_grip) <= kStartBonus * candidates.front().reach;
  std::vector<Joints> carries;
  if (start_is_good) carries.push_back(start);
  std::vector<Vec3> grips;
  for (const Candidate& candidate : candidates) {
    if (carries.size() >= kMostCarries) break;
    const Vec3& grip = table.grips()[candidate.sample].translation;
    const bool is_new = std::ranges::all_of(grips, [&](const Vec3& other) {
      return dot(grip - other, grip - other) > kApart * kApart;
    });
    if (!is_new) continue;
    grips.push_back(grip);
    carries.push_back(table.joints(arm, candidate.sample, start));
  }
  if (!start_is_good) carries.push_back(start);
  return carries;
}

}  // namespace galactic::scripted
