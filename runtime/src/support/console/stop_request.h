#pragma once
#include <atomic>
#include <csignal>
#include <functional>
#include <string>
#include <thread>

namespace galactic {

/// While it lives, Ctrl-C, SIGTERM, and SIGHUP of a terminal that closes, unless that is ignored
/// (nohup), are requests to end. The first one asks to begin nothing more; another Ctrl-C or
/// SIGTERM, half a second later or more, ends the program at once, whatever it is busy with. Make
/// it before other threads start: they inherit the signals' mask.
class StopRequest {
 public:
  /// `program`: who says on standard error that the request was heard.
  explicit StopRequest(std::string program);
  /// Of work that is not worth finishing, as nothing comes of a part of it: the first request ends
  /// the program at once, with kExitInterrupted. `last_words` says how the work goes on; called by
  /// another thread.
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
