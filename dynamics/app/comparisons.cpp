#include "comparisons.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "galactic/bake/parallel_for.h"
#include "support/console/standard_streams.h"
#include "support/try.h"

namespace galactic::dynamics {
namespace {

/// Shows the progress on a terminal.
class Progress {
 public:
  Progress(std::size_t done, std::size_t all, bool is_quiet)
      : done_(done), all_(all), is_shown_(!is_quiet && ::isatty(STDERR_FILENO) != 0) {}
  ~Progress() {
    if (is_shown_) printToStderr("\r\x1b[K");
  }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  Progress(Progress&&) = delete;
  Progress& operator=(Progress&&) = delete;

  void add() {
    const std::lock_guard lock(mutex_);
    ++done_;
    if (is_shown_) printToStderr(fmt::format("\rcompared {} of {} episodes", done_, all_));
  }

 private:
  std::size_t done_;
  std::size_t all_;
  bool is_shown_;
  std::mutex mutex_;
};

/// A pool of lanes for threads.
class LanePool {
 public:
  static Result<std::unique_ptr<LanePool>> create(const EpisodeSource& episodes,
                                                  std::size_t count) {
    auto pool = std::make_unique<LanePool>();
    for (std::size_t n = 0; n < count; ++n) {
      ASSIGN_OR_RETURN(auto lane, episodes.makeLane());
      pool->lanes_.push_back(std::move(lane));
    }
    return pool;
  }

  std::unique_ptr<EpisodeLane> take() {
    const std::lock_guard lock(mutex_);
    std::unique_ptr<EpisodeLane> lane = std::move(lanes_.back());
    lanes_.pop_back();
    return lane;
  }
  void giveBack(std::unique_ptr<EpisodeLane> lane) {
    const std::lock_guard lock(mutex_);
    lanes_.push_back(std::move(lane));
  }

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<EpisodeLane>> lanes_;
};

}  // namespace

Result<std::vector<EpisodeComparison>> compareAll(const EpisodeSource& episodes,
                                                  const ComparisonWorlds& worlds,
                                                  const Command& command, const StopRequest& stop,
                                                  ComparisonJournal* journal) {
  std::vector<std::optional<Result<EpisodeComparison>>> results(episodes.count());
  std::vector<std::size_t> open;
  for (std::size_t n = 0; n < results.size(); ++n) {
    const bool is_done = journal != nullptr && journal->done().contains(n);
    if (is_done) results[n] = journal->done().at(n);
    if (!is_done) open.push_back(n);
  }
  const std::size_t wanted =
      command.threads != 0 ? command.threads : std::max(1U, std::thread::hardware_concurrency());
  const std::size_t threads = std::min(wanted, open.size());
  ASSIGN_OR_RETURN(const auto lanes, LanePool::create(episodes, threads));
  Progress progress(results.size() - open.size(), results.size(), command.is_quiet);
  // After an I/O error, stop: further results could not be kept either.
  std::atomic<bool> is_lost = false;
  bake::parallelFor(static_cast<unsigned>(threads), open.size(), [&](std::size_t k) {
    if (stop.came() || is_lost) return;
    const std::size_t n = open[k];
    std::unique_ptr<EpisodeLane> lane = lanes->take();
    const auto compared = [&]() -> Result<EpisodeComparison> {
      ASSIGN_OR_RETURN(const auto trace, episodes.trace(n, *lane));
      ASSIGN_OR_RETURN(auto one,
                       compareEpisode(trace, *lane, worlds, episodes.actions(trace, *lane)));
      if (journal != nullptr) RETURN_IF_ERROR(journal->add(n, one));
      return one;
    };
    results[n] = compared();
    if (!*results[n] && results[n]->error().code == ErrorCode::kIo) is_lost = true;
    lanes->giveBack(std::move(lane));
    progress.add();
  });
  std::vector<EpisodeComparison> all;
  for (std::optional<Result<EpisodeComparison>>& result : results) {
    if (!result) continue;
    ASSIGN_OR_RETURN(auto one, std::move(*result));
    all.push_back(std::move(one));
  }
  return all;
}

}  // namespace galactic::dynamics
