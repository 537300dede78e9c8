#pragma once
#include <string>

#include "galactic/error.h"

namespace galactic::schema {
struct Robot;
}

namespace galactic::detail {

/// Checks every value of a robot whose structure has been verified. A robot that passes is safe for
/// forwardKinematics.
[[nodiscard]] Result<void> checkRobot(const schema::Robot& robot, const std::string& where);

}  // namespace galactic::detail
