#pragma once
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <tl/expected.hpp>

namespace galactic::bake {

/// What a child process may use.
struct ProcessLimits {
  std::chrono::milliseconds wall_clock{600'000};
  /// Bytes of memory beyond what the parent had when the child started.
  std::uint64_t memory = std::uint64_t{16} << 30U;
};

/// How a child process failed to deliver.
enum class ProcessEnd { kNotStarted, kCrashed, kTimeLimit, kMemoryLimit, kFailed };

struct ProcessFailure {
  ProcessEnd end = ProcessEnd::kNotStarted;
  /// Signal that ended the child (kCrashed), errno (kNotStarted) or exit code (kFailed).
  int number = 0;
  /// The last stage that the child announced.
  std::uint32_t stage = 0;
};

/// What a child wrote, in pages of its own; movable, not copyable.
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
  /// Announces what the child does next; the parent learns it even when the child crashes.
  virtual void enterStage(std::uint32_t stage) = 0;
};

using IsolatedWork = std::function<void(ProcessChannel&)>;

/// Runs `work` in a forked child and returns what it wrote, so that a crash, an endless loop or a
/// memory hog costs an error instead of this process. The child's standard streams go nowhere, and
/// it leaves without running destructors or exit handlers. `work` must use no other thread and no
/// lock that another thread of the parent may hold (malloc is safe with glibc). Thread-safe.
/// Throws ErrorException (kUnsupported) where somebody else killed the child, as a system does that
/// runs out of memory: that says nothing of what was read.
/// Sanitizers reserve terabytes of addresses: under them the parent watches the child's resident
/// memory instead of limiting its address space.
[[nodiscard]] tl::expected<ProcessOutput, ProcessFailure> runIsolated(const IsolatedWork& work,
                                                                      const ProcessLimits& limits);

/// Bytes that this process may map (RLIMIT_AS): where they are fewer than a child's limit, it is
/// they that it ran into.
[[nodiscard]] std::uint64_t ownMemoryLimit();

}  // namespace galactic::bake
