#pragma once
#include <tl/expected.hpp>
#include <variant>

#include "pack_tool/verbs/verbs.h"

namespace galactic::pack_tool {

/// What the user asked for: the options of one verb.
using Request = std::variant<InfoOptions, CheckOptions, ColumnOptions, DiffOptions, ExportOptions,
                             PictureOptions, ReportOptions, ViewOptions>;

/// Reads the command line. Where there is nothing to run, returns the exit code instead: help and
/// version were printed to console.out (0), or an error to console.err (kExitUsage).
[[nodiscard]] tl::expected<Request, int> parseCommandLine(int argc, const char* const* argv,
                                                          const Console& console);

}  // namespace galactic::pack_tool
