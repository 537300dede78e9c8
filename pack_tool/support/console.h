#pragma once
#include <ostream>

#include "galactic/error.h"
#include "support/printable.h"

namespace galactic::pack_tool {

/// Where a verb writes: its answer to `out`, what went wrong to `err`.
struct Console {
  std::ostream& out;
  std::ostream& err;
};

/// Prints "galactic-pack: <where>: <message>" to `err`; returns the error's exit code.
int reportError(const Console& console, const Error& error);

/// The more serious of two exit codes. Rising: ok, differs, unsupported, I/O, invalid input,
/// command line, internal.
[[nodiscard]] int worseExit(int a, int b);

}  // namespace galactic::pack_tool
