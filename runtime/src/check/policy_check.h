#pragma once
#include <string>

#include "galactic/error.h"

namespace galactic::schema {
struct Policy;
}

namespace galactic::detail {

/// Checks every value of a policy whose structure has been verified: what passes runs on any
/// observation and image. Whether it fits a robot is found when it meets one.
[[nodiscard]] Result<void> checkPolicy(const schema::Policy& policy, const std::string& where);

}  // namespace galactic::detail
