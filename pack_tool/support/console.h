#pragma once
#include <optional>
#include <ostream>
#include <string>

#include "galactic/error.h"
#include "support/text/printable.h"

namespace galactic::pack_tool {

/// Where a verb writes: its answer to `out`, what went wrong to `err`.
struct Console {
  std::ostream& out;
  std::ostream& err;
};

/// Prints "galactic-pack: <where>: <message>" to `err`; returns the error's exit code.
int reportError(const Console& console, const Error& error);

/// Prints "galactic-pack: warning: <sentence>" to `err`, where there is one.
void reportWarning(const Console& console, const std::optional<std::string>& sentence);

/// The more serious of two exit codes. Rising: ok, differs, unsupported, I/O, invalid input,
/// command line, internal.
[[nodiscard]] int worseExit(int a, int b);

}  // namespace galactic::pack_tool
