#pragma once
#include <atomic>
#include <csignal>
#include <string>
#include <thread>

namespace galactic {

/// While it lives, the first Ctrl-C or SIGTERM is a request to begin nothing more; the second, half
/// a second later or more, ends the program at once, whatever it is busy with. Make it before other
/// threads start: they inherit the signals' mask.
class StopRequest {
 public:
  /// `program`: who says on standard error that the request was heard.
  explicit StopRequest(std::string program);
  ~StopRequest();
  StopRequest(const StopRequest&) = delete;
  StopRequest& operator=(const StopRequest&) = delete;
  StopRequest(StopRequest&&) = delete;
  StopRequest& operator=(StopRequest&&) = delete;

  [[nodiscard]] bool came() const { return came_; }

 private:
  void watch();

  std::string program_;
  sigset_t signals_{};
  sigset_t before_{};
  std::atomic<bool> came_{false};
  std::atomic<bool> over_{false};
  std::thread watcher_;
};

}  // namespace galactic
