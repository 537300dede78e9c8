#pragma once
#include <ctime>

namespace galactic::detail {

/// What the calling thread took of the processor so far, in seconds: what others on the machine do
/// does not count.
[[nodiscard]] inline double threadSeconds() noexcept {
  std::timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace galactic::detail
