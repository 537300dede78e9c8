#pragma once
#include <string_view>

#include "galactic/error.h"

namespace galactic {

/// The error that a program reports when it has caught std::bad_alloc: how much memory it uses, how
/// much there is, and what to do. kUnsupported; where: "available memory".
[[nodiscard]] Error outOfMemory();

/// Fails if `bytes` exceeds what the machine has or what a limit (ulimit -v) leaves. Call it before
/// allocating, because a system that overcommits memory would kill the program instead.
/// kUnsupported; where: "available memory". `what` needs the memory, as the plural that begins the
/// sentence; `advice` says what to do.
[[nodiscard]] Result<void> checkMemory(double bytes, std::string_view what,
                                       std::string_view advice);

}  // namespace galactic
