#pragma once
#include <system_error>

#include "galactic/error.h"

namespace galactic {

/// What a program says that caught std::bad_alloc: how much memory it has in use, how much there
/// is, and what to do. kUnsupported; where: "memory".
[[nodiscard]] Error outOfMemory();

/// Whether it is memory that was lacking: a thread that cannot start lacks room for its stack.
[[nodiscard]] bool isOutOfMemory(const std::system_error& failure);

}  // namespace galactic
