#pragma once
#include <span>
#include <vector>

#include "galactic/pose.h"
#include "galactic/robot.h"

namespace galactic {

/// Tests whether a robot touches itself, by its spheres. BatchSimulator does not: there, a robot
/// may pass through itself. Immutable, so safe to share between threads.
class SelfCollision {
 public:
  /// Chooses the pairs of groups that are tested: Robot::testedPairs() but for those that touch
  /// where an episode starts. These say nothing: spheres stick out of what they cover, and those of
  /// neighbors on an arm touch nearly everywhere. `robot` must outlive this.
  explicit SelfCollision(const Robot& robot);

  /// The pairs that are tested, ascending.
  [[nodiscard]] std::span<const GroupPair> pairs() const { return pairs_; }

  /// Whether spheres of a tested pair are nearer to each other than `margin`, meters, which may be
  /// below 0: then, whether they overlap by more. `links`: the poses of all links, in whatever
  /// frame, as forwardKinematics() has them. Neither allocates nor throws.
  [[nodiscard]] bool touches(std::span<const Pose> links, float margin = 0) const noexcept;

 private:
  /// Around all spheres of a group, in its link's frame.
  struct Ball {
    Vec3 center;
    float radius = 0;
  };
  [[nodiscard]] static Ball ballAround(const Robot& robot, const SphereGroup& group);
  [[nodiscard]] bool areNear(const GroupPair& pair, std::span<const Pose> links,
                             float margin) const noexcept;

  const Robot* robot_;
  /// Of each group.
  std::vector<Ball> balls_;
  std::vector<GroupPair> pairs_;
};

}  // namespace galactic
