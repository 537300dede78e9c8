#pragma once
#include <string_view>

#include "galactic/error.h"

namespace galactic {

/// What a program says that caught std::bad_alloc: how much memory it has in use, how much there
/// is, and what to do. kUnsupported; where: "available memory".
[[nodiscard]] Error outOfMemory();

/// An error where something known beforehand cannot fit: `bytes` are more than the machine has, or
/// than a limit (ulimit -v) leaves. Asked before they are allocated, because a system that promises
/// more than it has would kill the program instead. kUnsupported; where: "available memory". `what`
/// needs them, as the plural that begins the sentence; `advice` says what to do.
[[nodiscard]] Result<void> checkMemory(double bytes, std::string_view what,
                                       std::string_view advice);

}  // namespace galactic
