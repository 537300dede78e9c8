#include "support/console/stop_request.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <utility>

#include "galactic/error.h"
#include "support/console/standard_streams.h"

namespace galactic {
namespace {

bool isIgnored(int signal) {
  struct sigaction action {};
  return ::sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

/// Writing to a closed terminal fails, which would look as if results were lost on a full disk; so
/// redirect what is left to say to nowhere.
void leaveClosedTerminals() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::isatty(stream) == 1 || errno != EIO) continue;
    const int nowhere = ::open("/dev/null", O_RDWR | O_CLOEXEC);
    if (nowhere < 0) return;
    ::dup2(nowhere, stream);
    ::close(nowhere);
  }
}

}  // namespace

StopRequest::StopRequest(std::string program) : StopRequest(std::move(program), {}) {}

StopRequest::StopRequest(std::string program, std::function<std::string()> last_words)
    : program_(std::move(program)), last_words_(std::move(last_words)) {
  sigemptyset(&signals_);
  sigaddset(&signals_, SIGINT);
  sigaddset(&signals_, SIGTERM);
  if (!isIgnored(SIGHUP)) sigaddset(&signals_, SIGHUP);
  pthread_sigmask(SIG_BLOCK, &signals_, &before_);
  watcher_ = std::thread([this] { watch(); });
}

StopRequest::~StopRequest() {
  over_ = true;
  // The watcher waits for nothing else, and takes the signal with sigwait().
  // NOLINTNEXTLINE(bugprone-bad-signal-to-kill-thread)
  pthread_kill(watcher_.native_handle(), SIGTERM);
  watcher_.join();
  pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

void StopRequest::watch() {
  using Clock = std::chrono::steady_clock;
  // A sender that signals a process and its group, as timeout(1) does, asks once.
  constexpr std::chrono::milliseconds kSameRequest{500};
  Clock::time_point asked;
  while (true) {
    int signal = 0;
    if (sigwait(&signals_, &signal) != 0) continue;
    if (over_) return;
    if (signal == SIGHUP) leaveClosedTerminals();
    if (last_words_) {
      printToStderr(fmt::format("\n{}: {}\n", program_, last_words_()));
      ::_exit(kExitInterrupted);
    }
    const Clock::time_point now = Clock::now();
    if (came_) {
      // Files appear only when they are whole, so that leaving at once loses nothing. The kernel
      // and the shell both send SIGHUP when a terminal closes, so a second SIGHUP does not mean
      // that somebody insists.
      if (signal != SIGHUP && now - asked >= kSameRequest) ::_exit(kExitInterrupted);
      continue;
    }
    asked = now;
    came_ = true;
    printToStderr(
        fmt::format("\n{}: finishing what has begun; once more to stop at once\n", program_));
  }
}

}  // namespace galactic
