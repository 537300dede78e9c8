#include "support/out_of_memory.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <limits>
#include <string>

namespace galactic {
namespace {

constexpr double kMegabyte = 1e6;
constexpr double kGigabyte = 1e9;

/// "1.8 GB", and small amounts as "2.3 MB".
std::string memoryText(double bytes) {
  constexpr double kLittle = 0.1 * kGigabyte;
  return bytes < kLittle ? fmt::format("{:.1f} MB", bytes / kMegabyte)
                         : fmt::format("{:.1f} GB", bytes / kGigabyte);
}

/// Bytes that are mapped now; 0 when unknown.
double mappedBytes() {
  std::FILE* file = std::fopen("/proc/self/statm", "r");
  if (file == nullptr) return 0;
  unsigned long long pages = 0;
  const int read = std::fscanf(file, "%llu", &pages);
  std::fclose(file);
  return read == 1 ? static_cast<double>(pages) * static_cast<double>(::sysconf(_SC_PAGESIZE)) : 0;
}

double machineBytes() {
  return static_cast<double>(::sysconf(_SC_PHYS_PAGES)) *
         static_cast<double>(::sysconf(_SC_PAGESIZE));
}

/// Bytes of address space that a limit grants the process; infinity without a limit.
double limitBytes() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) {
    return std::numeric_limits<double>::infinity();
  }
  return static_cast<double>(limit.rlim_cur);
}

}  // namespace

Error outOfMemory() {
  return {
      ErrorCode::kUnsupported, "available memory",
      fmt::format("this needs more than the {} that there are ({} are in use); "
                  "do less at once, or raise the limit (ulimit -v)",
                  memoryText(std::min(machineBytes(), limitBytes())), memoryText(mappedBytes()))};
}

Result<void> checkMemory(double bytes, std::string_view what, std::string_view advice) {
  // Mapped memory counts against a limit, but is not the memory in use: files are mapped, and
  // sanitizers map terabytes.
  const double left = std::min(machineBytes(), limitBytes() - mappedBytes());
  if (bytes <= left) return {};
  return fail(ErrorCode::kUnsupported, "available memory",
              fmt::format("{} need {}, and there are {}; {}", what, memoryText(bytes),
                          memoryText(std::max(0.0, left)), advice));
}

}  // namespace galactic
