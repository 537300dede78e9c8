#pragma once
#include <string>
#include <utility>
#include <vector>

#include "galactic/bake/source_robot.h"

namespace galactic::bake {

/// Where the links of `furniture` are, seen from its root, one for each: all joints at 0, or at the
/// nearest end of their limits, but for those in `positions`. These are by name of joint, where all
/// of them are such names, else for the joints with one position in the order of a walk through the
/// tree, children by name of joint. Radians and meters.
[[nodiscard]] std::vector<Affine> restPose(
    const SourceRobot& furniture, const std::vector<std::pair<std::string, double>>& positions);

}  // namespace galactic::bake
