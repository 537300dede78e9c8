#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "scripted/arm.h"
#include "scripted/inverse_kinematics.h"

namespace galactic::scripted {

/// Positions of the arm drawn uniformly within its limits, with the grip's pose in each: where
/// inverse kinematics begins. Depends only on the robot.
class ReachTable {
 public:
  /// Joints that no action moves stay at `positions`. Leaves out samples in which the robot touches
  /// itself.
  ReachTable(Arm& arm, const Joints& positions, std::uint32_t samples);

  [[nodiscard]] std::size_t size() const { return grips_.size(); }
  /// `others` with the controlled joints of sample n. `arm` must be the one that the table was made
  /// for.
  [[nodiscard]] Joints joints(const Arm& arm, std::size_t n, const Joints& others) const;
  /// The direction from the root in which the arm reaches on average: an angle about +Y from the
  /// direction in which the base drives, radians, rounded to a sixteenth of a turn. 0 if the arm
  /// reaches equally far all round.
  [[nodiscard]] float bearing() const { return bearing_; }
  /// The largest distance of any grip from the root's vertical axis, meters.
  [[nodiscard]] float farthest() const { return farthest_; }
  /// root_from_grip of each sample.
  [[nodiscard]] std::span<const Pose> grips() const { return grips_; }

 private:
  std::size_t joints_ = 0;
  std::vector<float> rows_;
  std::vector<Pose> grips_;
  float bearing_ = 0;
  float farthest_ = 0;
};

/// Where one point and one direction of the hand are in each sample of a table.
class ReachView {
 public:
  /// `table` must outlive the view. Point and direction: frame of the grip.
  ReachView(const ReachTable& table, const Vec3& point, const Vec3& direction);

  /// The samples nearest to the goal's place and direction, nearest first: indices into the table,
  /// at most as many as `out` has room for. Leaves out samples farther away than `farthest`.
  /// Returns their number.
  std::size_t nearest(const HandGoal& goal, float farthest, std::span<std::uint32_t> out) const;

 private:
  struct Entry {
    Vec3 point;
    Vec3 direction;
  };
  std::vector<Entry> entries_;
};

}  // namespace galactic::scripted
