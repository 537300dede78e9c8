#pragma once
#include "galactic/error.h"

namespace galactic {

/// The error that a program reports for the exception that it is handling where it expects none:
/// memory ran out, its output cannot be written (printing throws), or else the program itself is at
/// fault. Call it in a catch block.
[[nodiscard]] Error errorOfException();

}  // namespace galactic
