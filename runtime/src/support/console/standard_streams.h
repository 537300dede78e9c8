#pragma once
#include <string_view>

namespace galactic {

/// The part of prepareProgram() that makes a program end with an exit code when its output cannot
/// be written. Fills the places of standard streams that the caller has closed, so that no file or
/// pipe that the program opens is mistaken for one of them; reading and writing them still fails. A
/// file that exceeds the file size limit (ulimit -f) becomes a write error.
void prepareStandardStreams() noexcept;

/// Writes to standard error. Never throws: text that cannot be written, for example to a full disk,
/// is lost, and only the program's exit code remains.
void printToStderr(std::string_view text) noexcept;

/// Flushes standard output and returns the exit code for `program`. If anything that it printed was
/// lost, kExitOk and kExitDiffers become kIo, and a line on standard error says so: a full disk
/// behind a redirection must not look like success.
[[nodiscard]] int flushStandardOutput(std::string_view program, int exit_code);

}  // namespace galactic
