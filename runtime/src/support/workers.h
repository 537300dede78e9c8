#pragma once
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <thread>
#include <vector>

namespace galactic::detail {

/// 0: as many threads as there are processors.
[[nodiscard]] std::uint32_t threadCount(std::uint32_t wanted) noexcept;

/// Calls `work(n)` once for each n below `count`, in no particular order, on up to `threads`
/// threads, the caller's included. `work` must not throw. For work that is done once.
void forEachPart(std::uint32_t threads, std::size_t count,
                 const std::function<void(std::size_t)>& work);

/// Threads that share a piece of work in parts, again and again. Each part of a round is done once,
/// by whichever thread takes it first: a thread begins with the part that it also did last time,
/// and then helps with what nobody has begun. The caller helps too while it waits, so there is one
/// thread fewer than parts, but at least one, so that the caller may do something else in between.
/// Nothing locks. Threads wait awake for a short time, so that rounds that follow each other
/// closely start at once, then asleep.
class Workers {
 public:
  /// `work(n)` does part n of `parts`; it must not throw.
  Workers(std::size_t parts, std::function<void(std::size_t)> work);
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  /// Starts a round. What was written before is seen by whoever does a part.
  void begin() noexcept;
  /// Helps, then waits for the end of the round. What the parts wrote is seen afterwards.
  void end() noexcept;

 private:
  void run(std::size_t own) noexcept;
  /// Does the parts that nobody has begun in this round, from `own` on and around.
  void doParts(std::uint32_t round, std::size_t own) noexcept;

  std::function<void(std::size_t)> work_;
  std::atomic<std::uint32_t> round_{0};
  /// Parts that are not done yet.
  std::atomic<std::uint32_t> left_{0};
  std::atomic<bool> stops_{false};
  /// The round in which each part was begun last.
  std::vector<std::atomic<std::uint32_t>> begun_;
  std::vector<std::jthread> threads_;
};

}  // namespace galactic::detail
