#pragma once
#include <chrono>
#include <cstddef>
#include <mutex>
#include <set>
#include <string>

#include "options.h"
#include "plan/plan_outcome.h"
#include "progress_line.h"

namespace galactic::bake {

/// Shows how a plan goes: on a terminal one line with an estimate of what is left, elsewhere a line
/// for each pack that is done. Thread-safe.
class PlanProgress {
 public:
  PlanProgress(std::size_t count, Verbosity verbosity);

  void begin(const std::string& pack);
  void end(const PackOutcome& pack);

 private:
  void show();

  std::mutex mutex_;
  std::size_t count_;
  Verbosity verbosity_;
  ProgressLine line_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::set<std::string> running_;
  std::size_t done_ = 0;
  std::size_t baked_ = 0;
};

}  // namespace galactic::bake
