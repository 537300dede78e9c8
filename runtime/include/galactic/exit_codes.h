#pragma once

namespace galactic {

/// What --help of all tools says of their exit codes: those of error.h, and that of an interrupt.
inline constexpr const char* kExitCodesHelp =
    "Exit codes:\n"
    "  0    success\n"
    "  1    wrong command line\n"
    "  2    a file cannot be read or written\n"
    "  3    invalid input\n"
    "  4    internal error\n"
    "  5    not supported\n"
    "  7    packs or runs differ\n"
    "  130  interrupted\n";

}  // namespace galactic
