#pragma once
#include "robot_description/description.h"
#include "robot_description/mjcf/attributes.h"
#include "robot_description/mjcf/bodies.h"

namespace galactic::bake {

/// Adds to the joints and links of `robot` what `root` says of them elsewhere:
///
/// - <equality> <joint>: one of the two follows the other, as with <mimic> of a URDF. Where several
///   couple the same joints, each follows one that is free; polynomials that are no straight lines
///   are warned of.
/// - <keyframe> "home": where the robot rests.
/// - <contact> <exclude>: links that may touch.
///
/// <connect> and <weld>, which close loops, are warned of.
void addCouplings(const XmlElement& root, const MjcfDefaults& defaults, const MjcfWorld& world,
                  RobotDescription& robot);

}  // namespace galactic::bake
