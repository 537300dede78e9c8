#include "galactic/bake/parallel_for.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace galactic::bake {
namespace {

/// The first exception of all threads.
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

void parallelFor(unsigned jobs, std::size_t count, const std::function<void(std::size_t)>& body) {
  std::atomic<std::size_t> next{0};
  FirstException failure;
  const auto work = [&] {
    try {
      for (std::size_t index = next++; index < count; index = next++) body(index);
    } catch (...) {
      failure.remember();
      next = count;
    }
  };
  {
    const std::size_t threads = std::min<std::size_t>(std::max(1U, jobs), count);
    std::vector<std::jthread> helpers;
    try {
      for (std::size_t i = 1; i < threads; ++i) helpers.emplace_back(work);
    } catch (const std::system_error&) {
      // The system has no more threads: those that started do the work.
    }
    work();
  }
  failure.rethrow();
}

}  // namespace galactic::bake
