#pragma once
#include <cstdint>
#include <optional>

#include "scripted/arm.h"

namespace galactic::scripted {

/// What the hand has to do: a point fixed to it comes to a place, and a direction fixed to it to a
/// direction. Turns about that direction stay free.
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
  /// Farthest that the point may stay from its place, meters.
  float tolerance = 0.002F;
  /// Farthest angle between direction and goal, radians. Negative: any direction does.
  float direction_tolerance = 0.15F;
  /// How much a radian of direction counts beside a meter of position.
  float direction_weight = 0.15F;
  /// Damping of the least squares, meters per radian.
  float damping = 0.03F;
  /// Farthest move of a joint in one iteration, radians or meters.
  float longest_move = 0.35F;
};

/// What moves the hand.
enum class Movers : std::uint8_t { kArm, kArmAndTurnOfBase };
/// How many of five things `movers` choose at once about these positions: the place of the grip,
/// three, and the direction of its X axis, two. 5 for a usual arm of five joints or more, 2 for a
/// lift with a telescope.
[[nodiscard]] int handFreedoms(Arm& arm, const Joints& positions, Movers movers);

/// Positions of the controlled joints, inside their limits, that reach the goal; none when the
/// iteration from `seed` does not get there. Damped least squares on position and direction
/// (Wampler 1986), the Jacobian from the links' axes.
[[nodiscard]] std::optional<Joints> solveHand(Arm& arm, const HandGoal& goal, const Joints& seed,
                                              const InverseKinematicsOptions& options = {});

/// Joints, with the turn of the base that they need: an angle about +Y, radians.
struct TurnedHand {
  Joints joints;
  float turn = 0;
};
/// The same where the base turns with the arm, by `most_turn` to either side at most: what an arm
/// of few joints lacks. The goal is in the frame of the root before the turn.
[[nodiscard]] std::optional<TurnedHand> solveHandAndTurn(
    Arm& arm, const HandGoal& goal, const Joints& seed, float most_turn,
    const InverseKinematicsOptions& options = {});

}  // namespace galactic::scripted
