#pragma once
#include "galactic/error.h"

namespace galactic {

/// What a program says of the exception that it is handling, where none is expected: that memory
/// was lacking, that its output cannot be written to, which printing throws, or else that it is at
/// fault. Called in a catch block.
[[nodiscard]] Error errorOfException();

}  // namespace galactic
