#include "support/threads/workers.h"

#include <unistd.h>

#include <algorithm>
#include <exception>
#include <memory>
#include <mutex>
#include <system_error>
#include <utility>

#include "galactic/simulation_options.h"

namespace galactic::detail {
namespace {

/// Waits until `value` differs from `old`.
template <class Value>
void awaitChange(const std::atomic<Value>& value, Value old) noexcept {
  // About 20 microseconds, the time that it takes to wake a thread. Looking for longer would take
  // the processor from other programs, or from the very thread that is awaited.
  constexpr int kLooks = 600;
  for (int n = 0; n < kLooks; ++n) {
    if (value.load(std::memory_order_acquire) != old) return;
#if defined(__x86_64__)
    __builtin_ia32_pause();
#endif
  }
  value.wait(old, std::memory_order_acquire);
}

/// The first exception of any thread.
class FirstException {
 public:
  void remember() {
    const std::lock_guard lock(mutex_);
    if (!exception_) exception_ = std::current_exception();
  }
  void rethrow() const {
    if (exception_) std::rethrow_exception(exception_);
  }

 private:
  std::mutex mutex_;
  std::exception_ptr exception_;
};

}  // namespace

std::uint32_t threadCount(std::uint32_t wanted) noexcept {
  const std::uint32_t count = wanted != 0 ? wanted : std::thread::hardware_concurrency();
  return std::clamp(count, 1U, kMostThreads);
}

void forEachPart(std::uint32_t threads, std::size_t count,
                 const std::function<void(std::size_t)>& work) {
  std::atomic<std::size_t> next{0};
  FirstException failure;
  const auto help = [&]() noexcept {
    try {
      for (std::size_t n = next++; n < count; n = next++) work(n);
    } catch (...) {
      failure.remember();
      next = count;
    }
  };
  {
    std::vector<std::jthread> helpers;
    try {
      for (std::size_t n = 1; n < std::min<std::size_t>(threads, count); ++n) {
        helpers.emplace_back(help);
      }
    } catch (const std::system_error&) {
      // The system has no more threads: those that started do the work.
    }
    help();
  }
  failure.rethrow();
}

Workers::Workers(std::size_t threads, std::size_t parts, Work work)
    : work_(std::move(work)), parts_(parts), ranges_(countFor(threads)), process_(getpid()) {
  const std::size_t count = ranges_.size();
  for (std::size_t n = 0; n < count; ++n) {
    ranges_[n].first = n * parts / count;
    ranges_[n].last = (n + 1) * parts / count;
    ranges_[n].next = ranges_[n].last;
  }
  threads_.reserve(count - 1);
  try {
    for (std::size_t n = 1; n < count; ++n) {
      threads_.emplace_back([this, n] { serve(n); });
    }
  } catch (const std::exception&) {
    // The system has no more threads, or no memory for their stacks: those that started do the
    // work. Throwing would wait for them to end, and they would wait for a round.
  }
}

Workers::Workers(std::size_t parts, std::function<void(std::size_t)> work)
    : Workers(parts, parts,
              [work = std::move(work)](std::size_t, std::size_t part) { work(part); }) {}

Workers::~Workers() {
  if (getpid() != process_) {
    // There is nothing to wait for: a fork leaves the threads behind in the parent process.
    // Destroying their handles is undefined behavior, so leak them.
    static_cast<void>(std::make_unique<std::vector<std::jthread>>(std::move(threads_)).release());
    return;
  }
  stops_.store(true, std::memory_order_relaxed);
  round_.fetch_add(1, std::memory_order_release);
  round_.notify_all();
}

void Workers::run() noexcept {
  const auto start = std::chrono::steady_clock::now();
  if (way_.next() == RoundWay::kTogether) {
    begin();
    end();
  } else {
    for (std::size_t part = 0; part < parts_; ++part) work_(0, part);
  }
  way_.add(std::chrono::steady_clock::now() - start);
}

void Workers::begin() noexcept {
  left_.store(parts_, std::memory_order_relaxed);
  // A thread that is still looking for parts of the last round may take one at once: the release
  // shows it what was written for this round.
  for (Range& range : ranges_) range.next.store(range.first, std::memory_order_release);
  round_.fetch_add(1, std::memory_order_release);
  round_.notify_all();
}

void Workers::end() noexcept {
  doParts(0);
  for (std::size_t left = left_.load(std::memory_order_acquire); left != 0;
       left = left_.load(std::memory_order_acquire)) {
    awaitChange(left_, left);
  }
}

void Workers::serve(std::size_t thread) noexcept {
  std::uint32_t seen = 0;
  while (true) {
    awaitChange(round_, seen);
    // A thread that slept through a round joins the current one.
    seen = round_.load(std::memory_order_acquire);
    if (stops_.load(std::memory_order_relaxed)) return;
    doParts(thread);
  }
}

void Workers::doParts(std::size_t thread) noexcept {
  for (std::size_t n = 0; n < ranges_.size(); ++n) {
    Range& range = ranges_[(thread + n) % ranges_.size()];
    std::size_t done = 0;
    for (std::size_t part = range.next.fetch_add(1, std::memory_order_acq_rel); part < range.last;
         part = range.next.fetch_add(1, std::memory_order_acq_rel)) {
      work_(thread, part);
      ++done;
    }
    if (done == 0) continue;
    if (left_.fetch_sub(done, std::memory_order_acq_rel) == done) left_.notify_all();
  }
}

}  // namespace galactic::detail
