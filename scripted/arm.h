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

/// A controlled joint as the planning of motions sees it.
struct ArmJoint {
  /// Index into the joint positions.
  std::uint32_t position = 0;
  float step = 0;
  float lower = 0;
  float upper = 0;
  /// A continuous joint without limits: positions that differ by a turn are the same.
  bool wraps = false;
  /// The first joint of the telescope that it is a segment of; itself when it is of none. Segments
  /// slide along one line with no turn between them, so that the hand feels their sum only.
  std::uint32_t leader = 0;
};

/// The controlled joints of a robot with its end effector, in the frame of the robot's root. Not
/// safe to share between threads: it has room for one set of link poses.
class Arm {
 public:
  /// `robot`, which has an end effector, must outlive the arm.
  explicit Arm(const Robot& robot);

  [[nodiscard]] const Robot& robot() const { return *robot_; }
  [[nodiscard]] std::span<const ArmJoint> joints() const { return joints_; }

  /// root_from_link of all links, valid until the next call.
  std::span<const Pose> placeLinks(std::span<const float> positions);
  /// root_from_grip for these link poses: origin at the grasp point, axes of the end effector's
  /// link, as EnvState has it.
  [[nodiscard]] Pose gripOf(std::span<const Pose> links) const;

  /// One column of the Jacobian for each controlled joint: how the end effector moves with it.
  struct Column {
    /// Of a turn: unit axis times the joint's factor; zero for a slide. Root frame.
    Vec3 turn;
    /// A point on the axis.
    Vec3 origin;
    /// Of a slide: direction times the factor.
    Vec3 slide;
  };
  void columns(std::span<const Pose> links, std::span<Column> out) const;

  /// How far controlled joint `joint` has to move, the shorter way round.
  [[nodiscard]] float difference(std::size_t joint, std::span<const float> from,
                                 std::span<const float> to) const;
  /// The largest difference of any controlled joint.
  [[nodiscard]] float distance(std::span<const float> from, std::span<const float> to) const;
  /// The most actions that any controlled joint needs, not rounded.
  [[nodiscard]] float actionsBetween(std::span<const float> from, std::span<const float> to) const;
  /// On the straight way in joint space; share 0: `from`, 1: `to`. The other joints are from's.
  void interpolate(std::span<const float> from, std::span<const float> to, float share,
                   Joints& out) const;
  /// Draws the controlled joints evenly within their limits; the others stay. The segments of a
  /// telescope all get the same share of their way: drawn one by one, their sum would nearly
  /// always be about half of the arm, and they would move in more actions.
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
  /// Links that move the end effector, each with the controlled joint whose position moves it.
  struct Mover {
    std::size_t link = 0;
    std::size_t joint = 0;
  };
  std::vector<Mover> movers_;
  SelfCollision self_collision_;
  std::vector<Pose> links_;
};

}  // namespace galactic::scripted
