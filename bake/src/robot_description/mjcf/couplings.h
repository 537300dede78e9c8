#pragma once
#include "robot_description/description.h"
#include "robot_description/mjcf/attributes.h"
#include "robot_description/mjcf/bodies.h"

namespace galactic::bake {

/// Adds to the joints and links of `robot` what other sections of `root` state about them:
/// - <equality> <joint>: one of the two joints follows the other, as with <mimic> in a URDF. If
///   several of these couple the same joints, each makes a joint follow that is still free.
///   Polynomials that are not straight lines cause a warning.
/// - <keyframe> "home": the rest pose of the robot.
/// - <contact> <exclude>: links that may touch.
///
/// <connect> and <weld>, which close loops, cause a warning.
void addCouplings(const XmlElement& root, const MjcfDefaults& defaults, const MjcfWorld& world,
                  RobotDescription& robot);

}  // namespace galactic::bake
