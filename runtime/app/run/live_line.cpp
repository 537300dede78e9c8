#include "run/live_line.h"

#include <fmt/format.h>
#include <unistd.h>

#include <string>

#include "support/console/standard_streams.h"
#include "support/console/terminal_line.h"

namespace galactic {

LiveLine::LiveLine(std::uint64_t steps, std::uint64_t envs)
    : steps_(steps), envs_(envs), enabled_(::isatty(STDERR_FILENO) == 1) {}

LiveLine::~LiveLine() {
  if (!shown_) return;
  printToStderr("\r\033[K");
}

void LiveLine::show(std::uint64_t done, const SimulationStatistics& sum) {
  if (!enabled_) return;
  const Clock::time_point now = Clock::now();
  const double seconds = std::chrono::duration<double>(now - last_time_).count();
  const auto stepped = static_cast<double>((done - last_done_) * envs_);
  const double refused =
      sum.steps == 0 ? 0 : static_cast<double>(sum.refused) / static_cast<double>(sum.steps);
  const std::string line =
      fmt::format("step {} of {}  {:.0f} steps/s  {:.1f} % refused  {} successes", done, steps_,
                  seconds > 0 ? stepped / seconds : 0, 100 * refused, sum.successes);
  printToStderr("\r\033[K" + fittingLine(line, STDERR_FILENO));
  shown_ = true;
  last_done_ = done;
  last_time_ = now;
}

}  // namespace galactic
