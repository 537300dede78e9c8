#pragma once
#include "galactic/error.h"

namespace galactic {

/// What a program says that caught std::bad_alloc: how much memory it has in use, how much there
/// is, and what to do. kUnsupported; where: "memory".
[[nodiscard]] Error outOfMemory();

}  // namespace galactic
