#pragma once
#include <condition_variable>
#include <cstdint>
#include <mutex>

namespace galactic::bake {

/// Keeps bakes that run at the same time within an amount of memory. Thread-safe.
class MemoryBudget {
 public:
  explicit MemoryBudget(std::uint64_t bytes) : bytes_(bytes) {}

  /// A part of the budget, for as long as it lives: it comes back whatever ends a bake, as others
  /// wait for it.
  class Share {
   public:
    /// Waits until `bytes` are free. What wants more than there is at all waits until it is alone.
    Share(MemoryBudget& budget, std::uint64_t bytes) : budget_(budget), bytes_(bytes) {
      budget_.take(bytes_);
    }
    ~Share() { budget_.giveBack(bytes_); }
    Share(const Share&) = delete;
    Share& operator=(const Share&) = delete;
    Share(Share&&) = delete;
    Share& operator=(Share&&) = delete;

   private:
    MemoryBudget& budget_;
    std::uint64_t bytes_;
  };

 private:
  void take(std::uint64_t bytes) {
    std::unique_lock lock(mutex_);
    freed_.wait(lock, [&] { return taken_ == 0 || taken_ + bytes <= bytes_; });
    taken_ += bytes;
  }

  void giveBack(std::uint64_t bytes) {
    {
      const std::lock_guard lock(mutex_);
      taken_ -= bytes;
    }
    freed_.notify_all();
  }

  std::mutex mutex_;
  std::condition_variable freed_;
  std::uint64_t bytes_;
  std::uint64_t taken_ = 0;
};

}  // namespace galactic::bake
