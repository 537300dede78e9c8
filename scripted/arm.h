#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "galactic/pose.h"
#include "galactic/robot.h"
#include "galactic/self_collision.h"
#include "support/random_stream.h"

namespace galactic::scripted {

/// All joint positions of a robot, radians or meters.
using Joints = std::vector<float>;

/// A controlled joint as motion planning sees it.
struct ArmJoint {
  /// Index into the joint positions.
  std::uint32_t position = 0;
  float step = 0;
  float lower = 0;
  float upper = 0;
  /// Whether this is a continuous joint without limits: positions that differ by a full turn are
  /// the same.
  bool wraps = false;
  /// The first joint of the telescope that this joint is a segment of; the joint itself if it is
  /// not part of one. Segments slide along one line with no turn between them, so that the hand
  /// depends only on their sum.
  std::uint32_t leader = 0;
};

/// The controlled joints of a robot with its end effector, in the frame of the robot's root.
/// Threads must not share it: it has room for one set of link poses.
class Arm {
 public:
  /// `robot` must have an end effector and outlive the arm.
  explicit Arm(const Robot& robot);

  [[nodiscard]] const Robot& robot() const { return *robot_; }
  [[nodiscard]] std::span<const ArmJoint> joints() const { return joints_; }

  /// root_from_link of all links, valid until the next call.
  std::span<const Pose> placeLinks(std::span<const float> positions);
  /// root_from_grip for these link poses: the origin is the grasp point, the axes are those of the
  /// end effector's link, as in EnvState.
  [[nodiscard]] Pose gripOf(std::span<const Pose> links) const;

  /// A column of the Jacobian for a controlled joint: how the end effector moves with the joint.
  struct Column {
    /// Unit axis of a turning joint times its factor; zero for a sliding joint. Root frame.
    Vec3 turn;
    /// A point on the axis.
    Vec3 origin;
    /// Direction of a sliding joint times its factor.
    Vec3 slide;
  };
  void columns(std::span<const Pose> links, std::span<Column> out) const;

  /// How far controlled joint `joint` has to move, going the shorter way round.
  [[nodiscard]] float difference(std::size_t joint, std::span<const float> from,
                                 std::span<const float> to) const;
  /// The largest difference over all controlled joints.
  [[nodiscard]] float distance(std::span<const float> from, std::span<const float> to) const;
  /// The number of actions, not rounded, that the slowest controlled joint needs.
  [[nodiscard]] float actionsBetween(std::span<const float> from, std::span<const float> to) const;
  /// Interpolates linearly in joint space; share 0 is `from`, 1 is `to`. The other joints are those
  /// of `from`.
  void interpolate(std::span<const float> from, std::span<const float> to, float share,
                   Joints& out) const;
  /// Draws the controlled joints uniformly within their limits; the others stay. The segments of a
  /// telescope all get the same share of their range: drawn one by one, their sum would nearly
  /// always be about half of the telescope's range, and reaching it would take more actions.
  void draw(RandomStream& random, Joints& positions) const;
  /// Adds `by` to a joint, within its limits.
  void move(std::size_t joint, float by, Joints& positions) const;

  /// See SelfCollision.
  [[nodiscard]] bool touchesItself(std::span<const Pose> links) const {
    return self_collision_.touches(links);
  }

 private:
  void joinTelescopes();

  const Robot* robot_;
  std::vector<ArmJoint> joints_;
  /// A link that moves the end effector, with the controlled joint whose position moves it.
  struct Mover {
    std::size_t link = 0;
    std::size_t joint = 0;
  };
  std::vector<Mover> movers_;
  SelfCollision self_collision_;
  std::vector<Pose> links_;
};

}  // namespace galactic::scripted
