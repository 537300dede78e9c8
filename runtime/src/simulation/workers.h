#pragma once
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <thread>
#include <vector>

namespace galactic::simulation {

/// Threads that all run one function, each with its own number, whenever they are told to. They
/// wait without a lock: for a short time awake, so that steps that follow each other closely start
/// at once, then asleep.
class Workers {
 public:
  /// `work(n)` runs in thread n of `count`; it must not throw.
  Workers(std::size_t count, std::function<void(std::size_t)> work);
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  /// Starts one round. What was written before is seen by the threads.
  void begin() noexcept;
  /// Waits for the end of the round. What the threads wrote is seen afterwards.
  void end() noexcept;

 private:
  void run(std::size_t n) noexcept;

  std::function<void(std::size_t)> work_;
  std::atomic<std::uint32_t> round_{0};
  std::atomic<std::uint32_t> running_{0};
  std::atomic<bool> stops_{false};
  std::vector<std::jthread> threads_;
};

}  // namespace galactic::simulation
