#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "galactic/robot.h"

namespace galactic {

/// The link whose joint owns each position of the robot, one per position. Of several joints with
/// one position the first that takes it as it is; the others mimic it. The largest number where no
/// joint has a position.
[[nodiscard]] std::vector<std::uint32_t> positionOwners(const Robot& robot);

/// What each position of a robot is called: its joint's name; with ".x", ".y" and ".angle" for
/// planar joints; with ".x", ".y", ".z", ".qx", ".qy", ".qz" and ".qw" for floating ones.
[[nodiscard]] std::vector<std::string> positionNames(const Robot& robot);

}  // namespace galactic
