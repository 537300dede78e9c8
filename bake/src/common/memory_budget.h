#pragma once
#include <algorithm>
#include <condition_variable>
#include <cstdint>
#include <mutex>

namespace galactic::bake {

/// Bytes of memory that it takes to bake a pack or to draw episodes in a scene, as measured on
/// meshes of 0.1 to 60 MB. A bake holds geometry, textures and grids, and twice the pack while it
/// is checked; episodes hold the triangles with their trees for rays and for Bullet.
/// `source_bytes`: size of the source files.
[[nodiscard]] inline std::uint64_t memoryFor(std::uint64_t source_bytes) {
  constexpr std::uint64_t kAtLeast = std::uint64_t{64} << 20U;
  constexpr std::uint64_t kPerByte = 13;
  constexpr std::uint64_t kMost = std::uint64_t{1} << 50U;
  return kAtLeast + kPerByte * std::min(source_bytes, kMost);
}

/// Keeps concurrent bakes within an amount of memory. Thread-safe.
class MemoryBudget {
 public:
  explicit MemoryBudget(std::uint64_t bytes) : bytes_(bytes) {}

  /// The whole budget.
  [[nodiscard]] std::uint64_t bytes() const { return bytes_; }

  /// Holds a part of the budget while it lives. The destructor returns it however a bake ends,
  /// because others wait for it.
  class Share {
   public:
    /// Waits until `bytes` are free. A share larger than the whole budget waits until there is no
    /// other.
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
