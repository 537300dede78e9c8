#include "support/console/standard_streams.h"

#include <fcntl.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <string>

#include "galactic/error.h"

namespace galactic {

void prepareStandardStreams() noexcept {
  std::signal(SIGXFSZ, SIG_IGN);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(stream, F_GETFD) != -1) continue;
    // open() returns the lowest free number: that of the closed stream. Opened in the mode that the
    // stream is not used in, so that using it still fails.
    (void)::open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY);
  }
}

void printToStderr(std::string_view text) noexcept {
  (void)std::fwrite(text.data(), 1, text.size(), stderr);
  (void)std::fflush(stderr);
}

int flushStandardOutput(std::string_view program, int exit_code) {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return exit_code;
  printToStderr(std::string(program) +
                ": standard output: cannot be written; check that it is open and that its disk has "
                "room\n");
  const bool is_success = exit_code == kExitOk || exit_code == kExitDiffers;
  return is_success ? static_cast<int>(ErrorCode::kIo) : exit_code;
}

}  // namespace galactic
