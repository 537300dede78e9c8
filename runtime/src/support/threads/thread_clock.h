#pragma once
#include <ctime>

namespace galactic::detail {

/// Processor time that the calling thread has used so far, in seconds; other load on the machine
/// does not count.
[[nodiscard]] inline double threadSeconds() noexcept {
  std::timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace galactic::detail
