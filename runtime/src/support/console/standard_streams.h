#pragma once
#include <string_view>

namespace galactic {

/// The part of prepareProgram() that has an output that cannot be written end a program with an
/// exit code. Fills the places of standard streams that the caller has closed, so that no file and
/// no pipe that the program opens is taken for one of them; reading and writing them fails, as
/// before. A file that grows beyond the limit of its size (ulimit -f) becomes an error of writing
/// it.
void prepareStandardStreams() noexcept;

/// Writes to standard error. Throws nothing: what cannot be written, such as behind a full disk, is
/// lost, and the exit code tells of it.
void printToStderr(std::string_view text) noexcept;

/// What `program` ends with. Where anything that it printed is lost, success, and that two things
/// differ, become kIo, and a line on standard error says so: a full disk behind a redirection must
/// not look like success.
[[nodiscard]] int flushStandardOutput(std::string_view program, int exit_code);

}  // namespace galactic
