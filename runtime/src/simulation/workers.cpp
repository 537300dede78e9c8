#include "simulation/workers.h"

#include <utility>

namespace galactic::simulation {
namespace {

/// Waits until `value` is no longer `old`.
void awaitChange(const std::atomic<std::uint32_t>& value, std::uint32_t old) noexcept {
  constexpr int kLooks = 4000;  // some tens of microseconds
  for (int n = 0; n < kLooks; ++n) {
    if (value.load(std::memory_order_acquire) != old) return;
#if defined(__x86_64__)
    __builtin_ia32_pause();
#endif
  }
  value.wait(old, std::memory_order_acquire);
}

}  // namespace

Workers::Workers(std::size_t count, std::function<void(std::size_t)> work)
    : work_(std::move(work)) {
  threads_.reserve(count);
  for (std::size_t n = 0; n < count; ++n) {
    threads_.emplace_back([this, n] { run(n); });
  }
}

Workers::~Workers() {
  stops_.store(true, std::memory_order_relaxed);
  round_.fetch_add(1, std::memory_order_release);
  round_.notify_all();
}

void Workers::begin() noexcept {
  running_.store(static_cast<std::uint32_t>(threads_.size()), std::memory_order_relaxed);
  round_.fetch_add(1, std::memory_order_release);
  round_.notify_all();
}

void Workers::end() noexcept {
  for (std::uint32_t left = running_.load(std::memory_order_acquire); left != 0;
       left = running_.load(std::memory_order_acquire)) {
    awaitChange(running_, left);
  }
}

void Workers::run(std::size_t n) noexcept {
  std::uint32_t seen = 0;
  while (true) {
    awaitChange(round_, seen);
    ++seen;
    if (stops_.load(std::memory_order_relaxed)) return;
    work_(n);
    if (running_.fetch_sub(1, std::memory_order_acq_rel) == 1) running_.notify_all();
  }
}

}  // namespace galactic::simulation
