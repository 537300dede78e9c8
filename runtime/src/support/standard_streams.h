#pragma once
#include <string_view>

namespace galactic {

/// Fills the places of standard streams that the caller has closed, so that no file and no pipe
/// that the program opens is taken for one of them. Reading and writing them fails, as before.
/// Called first of all in main().
void reserveStandardStreams();

/// Writes to standard error. Throws nothing: what cannot be written, such as behind a full disk, is
/// lost, and the exit code tells of it.
void printToStderr(std::string_view text);

}  // namespace galactic
