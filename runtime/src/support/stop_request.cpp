#include "support/stop_request.h"

#include <fmt/format.h>
#include <unistd.h>

#include <ctime>
#include <utility>

#include "support/standard_streams.h"

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
  watcher_.join();
  pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

void StopRequest::watch() {
  constexpr timespec kTick{.tv_sec = 0, .tv_nsec = 50'000'000};
  constexpr int kSignalBase = 128;
  while (!over_) {
    const int signal = sigtimedwait(&signals_, nullptr, &kTick);
    if (signal <= 0) continue;
    // Files appear only when they are whole, so that leaving at once loses nothing.
    if (came_.exchange(true)) ::_exit(kSignalBase + signal);
    printToStderr(
        fmt::format("\n{}: finishing what has begun; once more to stop at once\n", program_));
  }
}

}  // namespace galactic
