#pragma once
#include <cstdint>
#include <optional>

#include "scripted/arm.h"

namespace galactic::scripted {

/// A goal for the hand: a point fixed to it has to get to a place, and a direction fixed to it has
/// to point in a given direction. Turns about that direction stay free.
struct HandGoal {
  /// Frame of the grip, meters.
  Vec3 point;
  /// Frame of the grip, unit vector.
  Vec3 direction{1, 0, 0};
  /// Where the point has to be, frame of the robot's root, meters.
  Vec3 place;
  /// Where the direction has to point, frame of the robot's root, unit vector.
  Vec3 toward{1, 0, 0};
};

struct InverseKinematicsOptions {
  int most_iterations = 30;
  /// How far the point may stay from its place, meters.
  float tolerance = 0.002F;
  /// Largest angle between direction and goal, radians. Negative: any direction will do.
  float direction_tolerance = 0.15F;
  /// How much a radian of direction counts relative to a meter of position.
  float direction_weight = 0.15F;
  /// Damping of the least squares, meters per radian.
  float damping = 0.03F;
  /// Farthest move of a joint in one iteration, radians or meters.
  float longest_move = 0.35F;
};

/// What moves the hand.
enum class Movers : std::uint8_t { kArm, kArmAndTurnOfBase };
/// How many of five degrees of freedom `movers` control at these positions: three of the grip's
/// place and two of the direction of its X axis. 5 for a usual arm of five joints or more, 2 for a
/// lift with a telescope.
[[nodiscard]] int handFreedoms(Arm& arm, const Joints& positions, Movers movers);

/// Positions of the controlled joints, within their limits, that reach the goal; none if the
/// iteration from `seed` does not get there. Uses damped least squares on position and direction
/// (Wampler 1986), with the Jacobian computed from the links' axes.
[[nodiscard]] std::optional<Joints> solveHand(Arm& arm, const HandGoal& goal, const Joints& seed,
                                              const InverseKinematicsOptions& options = {});

/// Joint positions, and the turn of the base that they need: an angle about +Y, radians.
struct TurnedHand {
  Joints joints;
  float turn = 0;
};
/// The same, but the base may turn along with the arm, by at most `most_turn` to either side, to
/// make up for an arm of few joints. The goal is in the frame of the root before the turn.
[[nodiscard]] std::optional<TurnedHand> solveHandAndTurn(
    Arm& arm, const HandGoal& goal, const Joints& seed, float most_turn,
    const InverseKinematicsOptions& options = {});

}  // namespace galactic::scripted
