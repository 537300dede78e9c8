#include "episodes/home/arm_reach.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/random.h"
#include "galactic/self_collision.h"

namespace galactic::bake {
namespace {

/// Enough for some samples in each cell of a reach of 1 m: it has about 20 by 40 cells.
constexpr std::size_t kSamples = 40000;
constexpr std::uint64_t kSeed = 20231;
constexpr float kCell = 0.05F;

/// A position within the limits; of a full turn, that nearest to zero, where they are wide or there
/// are none.
float drawPosition(const ControlledJoint& joint, Random& random) {
  constexpr float kHalfTurn = std::numbers::pi_v<float>;
  const bool limited = joint.upper - joint.lower < 4 * kHalfTurn;
  const float lower =
      limited ? joint.lower : std::clamp(-kHalfTurn, joint.lower, joint.upper - 2 * kHalfTurn);
  const float upper = limited ? joint.upper : lower + 2 * kHalfTurn;
  return lower + static_cast<float>(random.unit()) * (upper - lower);
}

}  // namespace

ArmReach::ArmReach(const Robot& robot) : position_count_(robot.positionCount()) {
  Random random(kSeed);
  const SelfCollision self_collision(robot);
  const EndEffector& hand = *robot.endEffector();
  const Pose ground_from_root{{0, robot.base()->root_height, 0}, {}};
  std::vector<Pose> ground_from_link(robot.links().size());
  const std::span<const float> start = robot.startPositions();
  std::vector<float> positions(start.begin(), start.end());
  for (std::size_t n = 0; n < kSamples; ++n) {
    for (const ControlledJoint& joint : robot.controlledJoints()) {
      positions[joint.position] = drawPosition(joint, random);
    }
    forwardKinematics(robot.links(), ground_from_root, positions, ground_from_link);
    if (self_collision.touches(ground_from_link)) continue;
    const Vec3 point = ground_from_link[hand.link] * hand.grasp_point;
    samples_.push_back({.grasp_point = point,
                        .distance = std::hypot(point.x, point.z),
                        .row = static_cast<std::uint32_t>(rows_.size() / position_count_)});
    rows_.insert(rows_.end(), positions.begin(), positions.end());
  }
  std::sort(samples_.begin(), samples_.end(), [](const ArmSample& a, const ArmSample& b) {
    if (a.grasp_point.y != b.grasp_point.y) return a.grasp_point.y < b.grasp_point.y;
    return a.row < b.row;
  });
  fillTable();
}

void ArmReach::fillTable() {
  if (samples_.empty()) return;
  for (const ArmSample& sample : samples_) farthest_ = std::max(farthest_, sample.distance);
  lowest_ = samples_.front().grasp_point.y;
  const float range = samples_.back().grasp_point.y - lowest_;
  cells_ = static_cast<std::size_t>(farthest_ / kCell) + 1;
  table_.assign(cells_ * (static_cast<std::size_t>(range / kCell) + 1), false);
  for (const ArmSample& sample : samples_) {
    const auto row = static_cast<std::size_t>((sample.grasp_point.y - lowest_) / kCell);
    table_[row * cells_ + static_cast<std::size_t>(sample.distance / kCell)] = true;
  }
}

std::span<const ArmSample> ArmReach::between(float low, float high) const {
  const auto below = [](const ArmSample& sample, float height) {
    return sample.grasp_point.y < height;
  };
  const auto first = std::lower_bound(samples_.begin(), samples_.end(), low, below);
  const auto last = std::lower_bound(first, samples_.end(), high, below);
  return {first, last};
}

std::span<const float> ArmReach::positions(const ArmSample& sample) const {
  return std::span(rows_).subspan(std::size_t{sample.row} * position_count_, position_count_);
}

bool ArmReach::covers(float distance, float height) const {
  if (!(distance >= 0) || !(height >= lowest_) || distance > farthest_) return false;
  const auto row = static_cast<std::size_t>((height - lowest_) / kCell);
  const std::size_t cell = row * cells_ + static_cast<std::size_t>(distance / kCell);
  return cell < table_.size() && table_[cell];
}

}  // namespace galactic::bake
