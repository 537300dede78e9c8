#pragma once
#include <linux/perf_event.h>
#include <sys/ioctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cstdint>
#include <optional>

/// Counts what the calling thread's processor does, kernel excluded, from its start() to its
/// stop(). Where the system does not allow it (perf_event_paranoid, a virtual machine), there is no
/// count.
class HardwareCounter {
 public:
  /// `event`: PERF_COUNT_HW_...
  explicit HardwareCounter(std::uint64_t event) {
    perf_event_attr attributes{};
    attributes.size = sizeof(attributes);
    attributes.type = PERF_TYPE_HARDWARE;
    attributes.config = event;
    attributes.disabled = 1;
    attributes.exclude_kernel = 1;
    attributes.exclude_hv = 1;
    file_ = static_cast<int>(syscall(SYS_perf_event_open, &attributes, 0, -1, -1, 0));
  }
  HardwareCounter(const HardwareCounter&) = delete;
  HardwareCounter& operator=(const HardwareCounter&) = delete;
  ~HardwareCounter() {
    if (file_ >= 0) close(file_);
  }

  void start() const {
    if (file_ >= 0) ioctl(file_, PERF_EVENT_IOC_ENABLE, 0);
  }
  void stop() const {
    if (file_ >= 0) ioctl(file_, PERF_EVENT_IOC_DISABLE, 0);
  }
  [[nodiscard]] std::optional<double> count() const {
    std::uint64_t value = 0;
    if (file_ < 0 || read(file_, &value, sizeof(value)) != sizeof(value)) return std::nullopt;
    return static_cast<double>(value);
  }

 private:
  int file_ = -1;
};
