#pragma once
#include <map>
#include <string>
#include <vector>

#include "robot_description/description.h"
#include "robot_description/mjcf/attributes.h"
#include "robot_description/mjcf/bodies.h"

namespace galactic::bake {

/// Which bodies of the world are the robot, and what it hangs from.
struct RobotBodies {
  /// By index; with each, all that are in it.
  std::vector<bool> is_part;
  /// Whether the root is a link "world" that no body is: the robot moves against it, or stands
  /// askew.
  bool hangs_from_world = false;
  /// Whether joints lead from the world to the robot's first body, or it has several of them.
  bool moves_against_world = false;
  /// Whether the first body's joints let it go where it likes: a robot's base does by itself.
  bool drives_itself = false;
};

/// The body of the world that has joints, or the only one; several that are fixed to the world are
/// one robot (two arms). What is left out is warned of; an error where it is not clear.
[[nodiscard]] RobotBodies chooseRobot(const MjcfWorld& world, const std::string& where,
                                      MjcfFindings& findings);

/// Adds the links and joints of the robot. A body is a link of its name, in the body's frame; one
/// with several joints, or with a hinge beside its origin, has links without shape before it.
/// Cameras are links without shape, X along their view. Fixed joints are called after the link
/// below.
void addLinks(const MjcfWorld& world, const RobotBodies& chosen, const MjcfSettings& settings,
              DescriptionPart part, MjcfFindings& findings, RobotDescription& robot);

}  // namespace galactic::bake
