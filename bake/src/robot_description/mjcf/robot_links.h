#pragma once
#include <map>
#include <string>
#include <vector>

#include "robot_description/description.h"
#include "robot_description/mjcf/attributes.h"
#include "robot_description/mjcf/bodies.h"

namespace galactic::bake {

/// The bodies of the world that make up the robot, and what it is attached to.
struct RobotBodies {
  /// For each body, by index; includes all bodies inside the chosen ones.
  std::vector<bool> is_part;
  /// Whether the root is a link "world" that is not a body, because the robot moves relative to the
  /// world or stands askew.
  bool hangs_from_world = false;
  /// Whether joints connect the world to the robot's first body, or the robot has several first
  /// bodies.
  bool moves_against_world = false;
  /// Whether the joints of the first body let it go anywhere, as a robot's base does by itself.
  bool drives_itself = false;
};

/// Chooses the body of the world that has joints, or the only body; several that are fixed to the
/// world are one robot (two arms). Warns of bodies that are left out; reports an error if the
/// choice is not clear.
[[nodiscard]] RobotBodies chooseRobot(const MjcfWorld& world, const std::string& where,
                                      MjcfFindings& findings);

/// Adds the links and joints of the robot. A body becomes a link of the same name, in the body's
/// frame. If it has several joints, or a hinge beside its origin, it is preceded by links without
/// shape. Cameras become links without shape, with X along the view. Fixed joints are named after
/// the link below.
void addLinks(const MjcfWorld& world, const RobotBodies& chosen, const MjcfSettings& settings,
              DescriptionPart part, MjcfFindings& findings, RobotDescription& robot);

}  // namespace galactic::bake
