#pragma once
#include <span>
#include <vector>

#include "galactic/pose.h"
#include "galactic/robot.h"

namespace galactic {

/// Tests with its spheres whether a robot touches itself. BatchSimulator does not test this: there,
/// a robot may pass through itself. Immutable, so safe to share between threads.
class SelfCollision {
 public:
  /// Chooses the pairs of groups that are tested: Robot::testedPairs() except those that touch in
  /// the robot's start positions. Testing those would tell nothing: spheres stick out of what they
  /// cover, and the spheres of neighbors on an arm touch nearly everywhere. `robot` must outlive
  /// this.
  explicit SelfCollision(const Robot& robot);

  /// The pairs that are tested, ascending.
  [[nodiscard]] std::span<const GroupPair> pairs() const { return pairs_; }

  /// Whether spheres of a tested pair are nearer to each other than `margin`, meters. If `margin`
  /// is negative: whether they overlap by more than that. `links`: the poses of all links, in any
  /// common frame, as forwardKinematics() returns them. Neither allocates nor throws.
  [[nodiscard]] bool touches(std::span<const Pose> links, float margin = 0) const noexcept;

 private:
  /// A ball around all spheres of a group, in its link's frame.
  struct Ball {
    Vec3 center;
    float radius = 0;
  };
  [[nodiscard]] static Ball ballAround(const Robot& robot, const SphereGroup& group);
  [[nodiscard]] bool areNear(const GroupPair& pair, std::span<const Pose> links,
                             float margin) const noexcept;

  const Robot* robot_;
  /// One for each group.
  std::vector<Ball> balls_;
  std::vector<GroupPair> pairs_;
};

}  // namespace galactic
