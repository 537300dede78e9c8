#pragma once

namespace galactic {

/// What a program does first of all: prepareStandardStreams(), and that a mapped file that another
/// process cuts short, or that its disk no longer gives, ends the program with kIo and a sentence
/// on standard error in place of a bare SIGBUS. For programs only: who embeds the library has
/// handlers of its own.
void prepareProgram() noexcept;

}  // namespace galactic
