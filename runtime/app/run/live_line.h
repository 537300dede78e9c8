#pragma once
#include <chrono>
#include <cstdint>

#include "galactic/batch_simulator.h"

namespace galactic {

/// One line on a terminal that shows the progress of a run; silent if there is no terminal.
class LiveLine {
 public:
  using Clock = std::chrono::steady_clock;

  /// The whole batch is to do `steps` steps.
  LiveLine(std::uint64_t steps, std::uint64_t envs);
  ~LiveLine();
  LiveLine(const LiveLine&) = delete;
  LiveLine& operator=(const LiveLine&) = delete;
  LiveLine(LiveLine&&) = delete;
  LiveLine& operator=(LiveLine&&) = delete;

  [[nodiscard]] bool isEnabled() const { return enabled_; }
  /// `done` steps have been done; `sum` counts what happened in them.
  void show(std::uint64_t done, const SimulationStatistics& sum);

 private:
  std::uint64_t steps_;
  std::uint64_t envs_;
  bool enabled_;
  bool shown_ = false;
  std::uint64_t last_done_ = 0;
  Clock::time_point last_time_ = Clock::now();
};

}  // namespace galactic
