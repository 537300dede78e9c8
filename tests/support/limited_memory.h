#pragma once
#include <sys/resource.h>
#include <unistd.h>

#include <cstdint>
#include <fstream>

namespace galactic::test {

/// While it lives, the process may map so many bytes more than it has now. No use under a sanitizer
/// (kIsSanitized), which maps terabytes by itself.
class LimitedMemory {
 public:
  explicit LimitedMemory(std::uint64_t bytes) {
    std::ifstream file("/proc/self/statm");
    std::uint64_t pages = 0;
    file >> pages;
    getrlimit(RLIMIT_AS, &before_);
    rlimit limit = before_;
    limit.rlim_cur = pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE)) + bytes;
    setrlimit(RLIMIT_AS, &limit);
  }
  ~LimitedMemory() { setrlimit(RLIMIT_AS, &before_); }
  LimitedMemory(const LimitedMemory&) = delete;
  LimitedMemory& operator=(const LimitedMemory&) = delete;
  LimitedMemory(LimitedMemory&&) = delete;
  LimitedMemory& operator=(LimitedMemory&&) = delete;

 private:
  rlimit before_{};
};

}  // namespace galactic::test
