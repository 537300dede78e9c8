#include "support/workers.h"

#include <algorithm>
#include <utility>

namespace galactic::detail {
namespace {

/// Waits until `value` is no longer `old`.
void awaitChange(const std::atomic<std::uint32_t>& value, std::uint32_t old) noexcept {
  constexpr int kLooks = 30000;  // about a millisecond
  for (int n = 0; n < kLooks; ++n) {
    if (value.load(std::memory_order_acquire) != old) return;
#if defined(__x86_64__)
    __builtin_ia32_pause();
#endif
  }
  value.wait(old, std::memory_order_acquire);
}

}  // namespace

std::uint32_t threadCount(std::uint32_t wanted) noexcept {
  return wanted != 0 ? wanted : std::max(1U, std::thread::hardware_concurrency());
}

void forEachPart(std::uint32_t threads, std::size_t count,
                 const std::function<void(std::size_t)>& work) {
  std::atomic<std::size_t> next{0};
  const auto help = [&]() noexcept {
    for (std::size_t n = next++; n < count; n = next++) work(n);
  };
  std::vector<std::jthread> helpers;
  for (std::size_t n = 1; n < std::min<std::size_t>(threads, count); ++n) {
    helpers.emplace_back(help);
  }
  help();
}

Workers::Workers(std::size_t parts, std::function<void(std::size_t)> work)
    : work_(std::move(work)), begun_(parts) {
  const std::size_t threads = std::max<std::size_t>(1, parts - 1);
  threads_.reserve(threads);
  for (std::size_t n = 0; n < threads; ++n) {
    // The caller begins with part 0.
    threads_.emplace_back([this, own = (n + 1) % parts] { run(own); });
  }
}

Workers::~Workers() {
  stops_.store(true, std::memory_order_relaxed);
  round_.fetch_add(1, std::memory_order_release);
  round_.notify_all();
}

void Workers::begin() noexcept {
  left_.store(static_cast<std::uint32_t>(begun_.size()), std::memory_order_relaxed);
  round_.fetch_add(1, std::memory_order_release);
  round_.notify_all();
}

void Workers::end() noexcept {
  doParts(round_.load(std::memory_order_relaxed), 0);
  for (std::uint32_t left = left_.load(std::memory_order_acquire); left != 0;
       left = left_.load(std::memory_order_acquire)) {
    awaitChange(left_, left);
  }
}

void Workers::run(std::size_t own) noexcept {
  std::uint32_t seen = 0;
  while (true) {
    awaitChange(round_, seen);
    // A thread that slept through a round goes on with the one that is in work.
    seen = round_.load(std::memory_order_acquire);
    if (stops_.load(std::memory_order_relaxed)) return;
    doParts(seen, own);
  }
}

void Workers::doParts(std::uint32_t round, std::size_t own) noexcept {
  const std::size_t parts = begun_.size();
  for (std::size_t n = 0; n < parts; ++n) {
    const std::size_t part = (own + n) % parts;
    std::uint32_t before = round - 1;
    if (!begun_[part].compare_exchange_strong(before, round, std::memory_order_acq_rel)) continue;
    work_(part);
    if (left_.fetch_sub(1, std::memory_order_acq_rel) == 1) left_.notify_all();
  }
}

}  // namespace galactic::detail
