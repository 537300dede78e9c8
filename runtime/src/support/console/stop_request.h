#pragma once
#include <atomic>
#include <csignal>
#include <functional>
#include <string>
#include <thread>

namespace galactic {

/// While it lives, Ctrl-C, SIGTERM and the SIGHUP of a closing terminal (unless ignored, as under
/// nohup) are requests to stop. The first one asks the program to begin nothing more; another
/// Ctrl-C or SIGTERM at least half a second later ends the program at once, whatever it is doing.
/// Create it before other threads start: they inherit the signal mask.
class StopRequest {
 public:
  /// `program`: the name under which standard error acknowledges the request.
  explicit StopRequest(std::string program);
  /// For work that is not worth finishing because a part of it yields nothing: the first request
  /// ends the program at once, with kExitInterrupted. `last_words` returns how to resume the work;
  /// another thread calls it.
  StopRequest(std::string program, std::function<std::string()> last_words);
  ~StopRequest();
  StopRequest(const StopRequest&) = delete;
  StopRequest& operator=(const StopRequest&) = delete;
  StopRequest(StopRequest&&) = delete;
  StopRequest& operator=(StopRequest&&) = delete;

  [[nodiscard]] bool came() const { return came_; }

 private:
  void watch();

  std::string program_;
  std::function<std::string()> last_words_;
  sigset_t signals_{};
  sigset_t before_{};
  std::atomic<bool> came_{false};
  std::atomic<bool> over_{false};
  std::thread watcher_;
};

}  // namespace galactic
