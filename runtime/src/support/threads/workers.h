#pragma once
#include <sys/types.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <thread>
#include <vector>

#include "support/threads/alone_or_together.h"

namespace galactic::detail {

/// As many as wanted, kMostThreads at most; 0: as many threads as there are processors.
[[nodiscard]] std::uint32_t threadCount(std::uint32_t wanted) noexcept;

/// Calls `work(n)` once for each n below `count`, in no particular order, on up to `threads`
/// threads, the caller's included. If a call throws, those that nobody has begun are left out, and
/// the caller gets the exception when all threads are done. For work that is done once.
void forEachPart(std::uint32_t threads, std::size_t count,
                 const std::function<void(std::size_t)>& work);

/// Threads that share a piece of work in parts, again and again. Each part of a round is done once,
/// by whichever thread takes it: each begins with its own range of parts, so that it meets the same
/// data in every round, and then helps with what others have not begun. More parts than threads
/// even out what neighbors on the machine take away. The caller helps too while it waits for the
/// end, so there is one thread fewer than asked for, but at least one, so that the caller may do
/// something else in between. Where the system gives fewer, those that it gives do the work.
/// Nothing locks. Threads wait awake only for as long as it takes to wake one up, so that rounds
/// that follow each other closely start at once, then asleep. A process that was forked between two
/// rounds has no threads but the one that forked, which does all the work there.
class Workers {
 public:
  /// Does a part; it must not throw. `thread`, below countFor(), is not at work on another part.
  using Work = std::function<void(std::size_t thread, std::size_t part)>;

  Workers(std::size_t threads, std::size_t parts, Work work);
  /// One part for each thread.
  Workers(std::size_t parts, std::function<void(std::size_t part)> work);
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  /// How many may be at work at a time for so many threads: the caller, as number 0, included.
  [[nodiscard]] static std::size_t countFor(std::size_t threads) {
    return std::max<std::size_t>(2, threads);
  }

  /// How many there are, the caller included: fewer than countFor() where the system gave no more.
  [[nodiscard]] std::size_t count() const noexcept { return threads_.size() + 1; }

  /// Does a round. Where the others would only be in its way, the caller does all parts.
  void run() noexcept;

  /// Starts a round of all threads. What was written before is seen by whoever does a part.
  void begin() noexcept;
  /// Helps, then waits for the end of the round. What the parts wrote is seen afterwards.
  void end() noexcept;

 private:
  /// The parts with which one thread begins.
  struct alignas(64) Range {
    std::atomic<std::size_t> next{0};
    std::size_t first = 0;
    std::size_t last = 0;
  };

  /// What a thread does until the end.
  void serve(std::size_t thread) noexcept;
  /// Does the parts that nobody has taken, those of `thread` first.
  void doParts(std::size_t thread) noexcept;

  Work work_;
  std::size_t parts_;
  std::atomic<std::uint32_t> round_{0};
  /// Parts that are not done yet.
  std::atomic<std::size_t> left_{0};
  std::atomic<bool> stops_{false};
  std::vector<Range> ranges_;
  AloneOrTogether way_;
  /// The process that the threads are in.
  pid_t process_;
  std::vector<std::jthread> threads_;
};

}  // namespace galactic::detail
