#pragma once
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <tl/expected.hpp>

namespace galactic::bake {

/// The resources that a child process may use.
struct ProcessLimits {
  std::chrono::milliseconds wall_clock{600'000};
  /// Bytes of memory beyond what the parent had when the child started.
  std::uint64_t memory = std::uint64_t{16} << 30U;
};

/// Why a child process did not deliver.
enum class ProcessEnd { kNotStarted, kCrashed, kTimeLimit, kMemoryLimit, kFailed };

struct ProcessFailure {
  ProcessEnd end = ProcessEnd::kNotStarted;
  /// The signal that ended the child (kCrashed), errno (kNotStarted) or the exit code (kFailed).
  int number = 0;
  /// The last stage that the child announced.
  std::uint32_t stage = 0;
};

/// The bytes that a child wrote, in memory pages of their own; movable, not copyable.
class ProcessOutput {
 public:
  explicit ProcessOutput(std::span<const std::byte> mapped) : bytes_(mapped) {}
  ~ProcessOutput();
  ProcessOutput(ProcessOutput&& other) noexcept;
  ProcessOutput& operator=(ProcessOutput&& other) noexcept;
  ProcessOutput(const ProcessOutput&) = delete;
  ProcessOutput& operator=(const ProcessOutput&) = delete;

  [[nodiscard]] std::span<const std::byte> bytes() const { return bytes_; }

 private:
  std::span<const std::byte> bytes_;
};

/// The child's way to talk to its parent. Not thread-safe.
class ProcessChannel {
 public:
  virtual ~ProcessChannel() = default;
  /// Appends to the output.
  virtual void write(std::span<const std::byte> bytes) = 0;
  /// Announces what the child does next; the parent learns of it even if the child crashes.
  virtual void enterStage(std::uint32_t stage) = 0;
};

using IsolatedWork = std::function<void(ProcessChannel&)>;

/// Runs `work` in a forked child and returns what it wrote, so that a crash, an endless loop or
/// excessive use of memory causes an error instead of taking this process down. The child's
/// standard streams are /dev/null, and it exits without running destructors or exit handlers.
/// `work` must use no other thread and no lock that another thread of the parent may hold (malloc
/// is safe with glibc). Thread-safe.
/// Throws ErrorException (kUnsupported) if somebody else killed the child, as the system does when
/// it runs out of memory: this says nothing about the file being read.
/// Sanitizers reserve terabytes of address space: under them the parent watches the child's
/// resident memory instead of limiting its address space.
[[nodiscard]] tl::expected<ProcessOutput, ProcessFailure> runIsolated(const IsolatedWork& work,
                                                                      const ProcessLimits& limits);

/// Bytes that this process may map (RLIMIT_AS). If this is less than the child's limit, it is the
/// limit that the child ran into.
[[nodiscard]] std::uint64_t ownMemoryLimit();

}  // namespace galactic::bake
