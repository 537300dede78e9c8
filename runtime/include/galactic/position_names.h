#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "galactic/robot.h"

namespace galactic {

/// The link whose joint owns each position of the robot, one per position. If several joints share
/// a position, the first that uses it unchanged is the owner; the others mimic it. The largest
/// std::uint32_t if no joint owns the position.
[[nodiscard]] std::vector<std::uint32_t> positionOwners(const Robot& robot);

/// The name of each position of a robot: its joint's name, followed by ".x", ".y" or ".angle" for
/// planar joints, and by ".x", ".y", ".z", ".qx", ".qy", ".qz" or ".qw" for floating ones.
[[nodiscard]] std::vector<std::string> positionNames(const Robot& robot);

}  // namespace galactic
