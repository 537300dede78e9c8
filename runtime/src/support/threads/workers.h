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

/// `wanted` threads, kMostThreads at most; 0: one per processor.
[[nodiscard]] std::uint32_t threadCount(std::uint32_t wanted) noexcept;

/// Calls `work(n)` once for each n below `count`, in no particular order, on up to `threads`
/// threads, including the caller's. If a call throws, calls that have not begun are skipped, and
/// the caller gets the exception when all threads are done. For work that is done only once.
void forEachPart(std::uint32_t threads, std::size_t count,
                 const std::function<void(std::size_t)>& work);

/// Threads that share a piece of work in parts, again and again. Each part of a round is done once,
/// by whichever thread takes it: each thread begins with its own range of parts, so that it meets
/// the same data in every round, and then helps with parts that nobody has begun. With more parts
/// than threads, the others make up for a thread that other programs slow down. The caller helps
/// too while it waits for the end, so there is one thread fewer than asked for, but at least one,
/// so that the caller can do something else in between. If the system provides fewer threads, those
/// do the work. Nothing locks. Threads wait awake only for about the time that it takes to wake one
/// up, so that rounds in close succession start at once; then they sleep. A process that was forked
/// between two rounds has only the thread that forked, which does all the work there.
class Workers {
 public:
  /// Does a part; must not throw. `thread`, below countFor(), is not busy with another part.
  using Work = std::function<void(std::size_t thread, std::size_t part)>;

  Workers(std::size_t threads, std::size_t parts, Work work);
  /// One part for each thread.
  Workers(std::size_t parts, std::function<void(std::size_t part)> work);
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  /// How many threads may be at work at the same time when `threads` are asked for, including the
  /// caller as number 0.
  [[nodiscard]] static std::size_t countFor(std::size_t threads) {
    return std::max<std::size_t>(2, threads);
  }

  /// How many threads there are, including the caller: fewer than countFor() if the system provided
  /// fewer.
  [[nodiscard]] std::size_t count() const noexcept { return threads_.size() + 1; }

  /// Does a round. If the other threads would only be in the way, the caller does all parts.
  void run() noexcept;

  /// Starts a round on all threads. All parts see what was written before.
  void begin() noexcept;
  /// Helps, then waits for the end of the round. What the parts wrote is visible afterwards.
  void end() noexcept;

 private:
  /// The parts that one thread begins with.
  struct alignas(64) Range {
    std::atomic<std::size_t> next{0};
    std::size_t first = 0;
    std::size_t last = 0;
  };

  /// The main loop of a thread.
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
  /// The process that the threads belong to.
  pid_t process_;
  std::vector<std::jthread> threads_;
};

}  // namespace galactic::detail
