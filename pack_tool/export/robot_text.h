#pragma once
#include <string>

#include "galactic/robot.h"

namespace galactic::pack_tool {

// Robots of packs as the texts that other tools read, in the URDF's frame: X forward, Z up, where
// the pack has X forward, Y up. Numbers read back to the floats of the pack.

/// SRDF text (MoveIt) with a <link_sphere_approximation> for each link. Links without spheres of
/// their own get MoveIt's way to say so: a single one of radius 0. Links that no joint moves
/// against each other share their spheres: they stand at the one nearest to the root. Then a
/// <disable_collisions> for each pair of links that is not to be tested against each other, with
/// MoveIt's reasons: Adjacent where one joint or none is between them, Always and Never as the bake
/// found it, User where the recipe says so, and Default where the spheres touch at the start
/// (SelfCollision).
[[nodiscard]] std::string srdfText(const Robot& robot);

/// URDF text of the robot's links and joints with its spheres as the only geometry, as the tools
/// foam and VAMP read it. Effort and velocity limits, which a pack does not keep, are written as 0;
/// a revolute joint without limits becomes a continuous one; joints that share a position mimic its
/// owner. Rotations as roll, pitch and yaw, exact to the rounding of floats.
[[nodiscard]] std::string spherizedUrdfText(const Robot& robot);

}  // namespace galactic::pack_tool
