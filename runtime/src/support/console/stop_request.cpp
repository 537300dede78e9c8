#include "support/console/stop_request.h"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <utility>

#include "support/console/standard_streams.h"

namespace galactic {

StopRequest::StopRequest(std::string program) : program_(std::move(program)) {
  sigemptyset(&signals_);
  sigaddset(&signals_, SIGINT);
  sigaddset(&signals_, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals_, &before_);
  watcher_ = std::thread([this] { watch(); });
}

StopRequest::~StopRequest() {
  over_ = true;
  // It waits for nothing else, and takes the signal with sigwait().
  // NOLINTNEXTLINE(bugprone-bad-signal-to-kill-thread)
  pthread_kill(watcher_.native_handle(), SIGTERM);
  watcher_.join();
  pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

void StopRequest::watch() {
  using Clock = std::chrono::steady_clock;
  // Who sends it to a process and to its group, as timeout(1) does, asks once.
  constexpr std::chrono::milliseconds kSameRequest{500};
  constexpr int kSignalBase = 128;
  Clock::time_point asked;
  while (true) {
    int signal = 0;
    if (sigwait(&signals_, &signal) != 0) continue;
    if (over_) return;
    const Clock::time_point now = Clock::now();
    if (came_) {
      // Files appear only when they are whole, so that leaving at once loses nothing.
      if (now - asked >= kSameRequest) ::_exit(kSignalBase + signal);
      continue;
    }
    asked = now;
    came_ = true;
    printToStderr(
        fmt::format("\n{}: finishing what has begun; once more to stop at once\n", program_));
  }
}

}  // namespace galactic
