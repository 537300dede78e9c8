#pragma once
#include <functional>
#include <tl/expected.hpp>

#include "pack_tool/support/console.h"

namespace galactic::pack_tool {

/// What the user asked for: runs a verb with its options, and returns the exit code.
using ChosenVerb = std::function<int(const Console&)>;

/// Reads the command line. Where there is nothing to run, returns the exit code instead: help and
/// version were printed to console.out (0), or an error to console.err (kExitUsage).
[[nodiscard]] tl::expected<ChosenVerb, int> parseCommandLine(int argc, const char* const* argv,
                                                             const Console& console);

}  // namespace galactic::pack_tool
