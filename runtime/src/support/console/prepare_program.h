#pragma once

namespace galactic {

/// The first call of a program. Calls prepareStandardStreams(), and makes the loss of a mapped file
/// (another process truncates it, or its disk fails) end the program with kIo and a sentence on
/// standard error instead of a bare SIGBUS. For programs only: applications that embed the library
/// have handlers of their own.
void prepareProgram() noexcept;

}  // namespace galactic
