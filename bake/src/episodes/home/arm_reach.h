#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "galactic/robot.h"

namespace galactic::bake {

/// One sampled position of the arm, with the base at the origin and facing +X.
struct ArmSample {
  /// The grasp point in meters, relative to the point on the ground under the base's center.
  Vec3 grasp_point;
  float distance = 0;
  /// Index of its row of joint positions.
  std::uint32_t row = 0;
};

/// The space that the robot reaches without driving, from forward kinematics of joint positions
/// drawn uniformly within the limits of the controlled joints; the other joints stay where an
/// episode starts.
class ArmReach {
 public:
  /// Draws from a random stream of its own, so that the samples depend only on the robot. Leaves
  /// out samples in which the robot touches itself (SelfCollision).
  explicit ArmReach(const Robot& robot);

  /// By ascending height of the grasp point.
  [[nodiscard]] std::span<const ArmSample> samples() const { return samples_; }
  /// The samples whose grasp point is between these heights above the ground, meters.
  [[nodiscard]] std::span<const ArmSample> between(float low, float high) const;
  /// The joint positions of a sample: one per position of the robot.
  [[nodiscard]] std::span<const float> positions(const ArmSample& sample) const;

  /// Whether any sample's grasp point is about there, that is, in the same cell of a table of 5 cm
  /// by 5 cm. Height above the ground and distance from the base's center, meters.
  [[nodiscard]] bool covers(float distance, float height) const;
  /// The farthest distance of any sample, meters.
  [[nodiscard]] float farthest() const { return farthest_; }

 private:
  void fillTable();

  std::size_t position_count_ = 0;
  std::vector<ArmSample> samples_;
  std::vector<float> rows_;
  float farthest_ = 0;
  float lowest_ = 0;
  std::size_t cells_ = 0;
  std::vector<bool> table_;
};

}  // namespace galactic::bake
