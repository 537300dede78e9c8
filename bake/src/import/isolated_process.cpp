#include "import/isolated_process.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <new>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define GALACTIC_UNDER_SANITIZER 1
#endif
#elif defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define GALACTIC_UNDER_SANITIZER 1
#endif
#ifdef GALACTIC_UNDER_SANITIZER
#include <sanitizer/common_interface_defs.h>
#endif

namespace galactic::bake {
namespace {

#ifdef GALACTIC_UNDER_SANITIZER
constexpr bool kUnderSanitizer = true;
#else
constexpr bool kUnderSanitizer = false;
#endif

// Exit codes of the child.
constexpr int kExitDelivered = 0;
constexpr int kExitOutOfMemory = 90;
constexpr int kExitException = 91;
constexpr int kExitOutput = 92;

constexpr std::size_t kBufferBytes = std::size_t{1} << 18U;
constexpr int kWatchIntervalMs = 20;

/// A file descriptor closed on scope exit.
class Descriptor {
 public:
  explicit Descriptor(int value) : value_(value) {}
  ~Descriptor() { reset(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  Descriptor(Descriptor&&) = delete;
  Descriptor& operator=(Descriptor&&) = delete;
  [[nodiscard]] int get() const { return value_; }
  void reset() {
    if (value_ >= 0) ::close(std::exchange(value_, -1));
  }

 private:
  int value_;
};

/// One word that parent and child share.
class SharedStage {
 public:
  SharedStage()
      : page_(::mmap(nullptr, sizeof(Word), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1,
                     0)) {
    if (page_ != MAP_FAILED) new (page_) Word(0);
  }
  ~SharedStage() {
    if (page_ != MAP_FAILED) ::munmap(page_, sizeof(Word));
  }
  SharedStage(const SharedStage&) = delete;
  SharedStage& operator=(const SharedStage&) = delete;
  SharedStage(SharedStage&&) = delete;
  SharedStage& operator=(SharedStage&&) = delete;

  [[nodiscard]] bool valid() const { return page_ != MAP_FAILED; }
  void set(std::uint32_t stage) { static_cast<Word*>(page_)->store(stage); }
  [[nodiscard]] std::uint32_t get() const { return static_cast<const Word*>(page_)->load(); }

 private:
  using Word = std::atomic<std::uint32_t>;
  static_assert(Word::is_always_lock_free);
  void* page_;
};

class MemoryFileChannel final : public ProcessChannel {
 public:
  MemoryFileChannel(int file, std::uint64_t limit, SharedStage& stage)
      : file_(file), left_(limit), stage_(stage) {
    buffer_.reserve(kBufferBytes);
  }

  void write(std::span<const std::byte> bytes) override {
    if (bytes.size() > left_) ::_exit(kExitOutOfMemory);
    left_ -= bytes.size();
    if (buffer_.size() + bytes.size() > kBufferBytes) flush();
    if (bytes.size() >= kBufferBytes) {
      writeAll(bytes);
    } else {
      buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
    }
  }

  void enterStage(std::uint32_t stage) override { stage_.set(stage); }

  void flush() {
    writeAll(buffer_);
    buffer_.clear();
  }

 private:
  void writeAll(std::span<const std::byte> bytes) const {
    while (!bytes.empty()) {
      const ssize_t written = ::write(file_, bytes.data(), bytes.size());
      if (written < 0 && errno == EINTR) continue;
      if (written <= 0) ::_exit(errno == ENOMEM ? kExitOutOfMemory : kExitOutput);
      bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
  }

  int file_;
  std::uint64_t left_;
  SharedStage& stage_;
  std::vector<std::byte> buffer_;
};

/// Pages of `process` from /proc: mapped (field 0) or resident (field 1); 0 when unknown.
std::uint64_t processBytes(pid_t process, int field) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "/proc/%d/statm", static_cast<int>(process));
  const Descriptor file(::open(text.data(), O_RDONLY | O_CLOEXEC));
  const ssize_t length = file.get() < 0 ? -1 : ::read(file.get(), text.data(), text.size() - 1);
  if (length <= 0) return 0;
  text[static_cast<std::size_t>(length)] = '\0';
  unsigned long long mapped = 0;
  unsigned long long resident = 0;
  if (std::sscanf(text.data(), "%llu %llu", &mapped, &resident) != 2) return 0;
  return (field == 0 ? mapped : resident) * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

using Resource = decltype(RLIMIT_AS);

void limitResource(Resource resource, std::uint64_t value) {
  rlimit limit{};
  if (::getrlimit(resource, &limit) != 0) return;
  const rlim_t wanted = std::min<rlim_t>(value, limit.rlim_max);
  limit = {wanted, wanted};
  ::setrlimit(resource, &limit);
}

/// Makes the child harmless: it dies with its parent, handles no signal, holds no descriptor but
/// its own and prints nothing.
void settleChild(const std::array<int, 2>& kept, const ProcessLimits& limits) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGTRAP, SIGALRM, SIGXCPU,
                           SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE, SIGUSR1, SIGUSR2}) {
    std::signal(signal, SIG_DFL);
  }
  sigset_t none;
  ::sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  const int nowhere = ::open("/dev/null", O_RDWR);
  for (const int stream : {0, 1, 2}) ::dup2(nowhere, stream);
  // Also other children's pipes, so that nobody waits for this child by mistake.
  const int low = std::min(kept[0], kept[1]);
  const int high = std::max(kept[0], kept[1]);
  if (low > 3) ::close_range(3, static_cast<unsigned>(low) - 1, 0);
  if (high > low + 1) {
    ::close_range(static_cast<unsigned>(low) + 1, static_cast<unsigned>(high) - 1, 0);
  }
  ::close_range(static_cast<unsigned>(high) + 1, ~0U, 0);

  limitResource(RLIMIT_CORE, 0);
  const auto seconds = std::chrono::ceil<std::chrono::seconds>(limits.wall_clock).count();
  // Behind the wall clock's limit, which gives the clearer message.
  constexpr std::int64_t kGraceSeconds = 5;
  limitResource(RLIMIT_CPU, static_cast<std::uint64_t>(seconds + kGraceSeconds));
  if (!kUnderSanitizer) {
    const std::uint64_t now = processBytes(::getpid(), 0);
    limitResource(RLIMIT_AS, limits.memory > ~std::uint64_t{0} - now ? ~std::uint64_t{0}
                                                                     : now + limits.memory);
  }
#ifdef GALACTIC_UNDER_SANITIZER
  // A fuzzer's death callback would record this child's crash as its own.
  __sanitizer_set_death_callback(nullptr);
#endif
}

[[noreturn]] void runChild(const IsolatedWork& work, MemoryFileChannel& channel) {
  try {
    work(channel);
    channel.flush();
  } catch (const std::bad_alloc&) {
    ::_exit(kExitOutOfMemory);
  } catch (...) {
    ::_exit(kExitException);
  }
  ::_exit(kExitDelivered);
}

/// Stands in for the limit of the address space, which sanitizers use up themselves.
class MemoryWatch {
 public:
  explicit MemoryWatch(const ProcessLimits& limits) {
    const std::uint64_t resident = kUnderSanitizer ? processBytes(::getpid(), 1) : 0;
    allowed_ = resident + std::min(limits.memory, ~resident);
  }
  [[nodiscard]] bool exceededBy(pid_t child) const {
    return kUnderSanitizer && processBytes(child, 1) > allowed_;
  }

 private:
  std::uint64_t allowed_ = 0;
};

/// Waits until the child has closed its end of the pipe. Returns why it had to be killed, if so.
std::optional<ProcessEnd> superviseChild(pid_t child, int pipe_end, const ProcessLimits& limits) {
  const auto deadline = std::chrono::steady_clock::now() + limits.wall_clock;
  const MemoryWatch memory(limits);
  while (true) {
    const auto left =
        std::chrono::ceil<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now());
    if (left.count() <= 0) return ProcessEnd::kTimeLimit;
    const auto longest = kUnderSanitizer ? kWatchIntervalMs : 1'000'000;
    pollfd waiting{pipe_end, POLLIN, 0};
    const int ready =
        ::poll(&waiting, 1, static_cast<int>(std::min<std::int64_t>(left.count(), longest)));
    if (ready > 0) return std::nullopt;
    if (ready < 0 && errno != EINTR) return ProcessEnd::kFailed;
    if (memory.exceededBy(child)) return ProcessEnd::kMemoryLimit;
  }
}

int reapChild(pid_t child) {
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

std::optional<ProcessFailure> judgeExit(int status) {
  if (WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    const auto end = signal == SIGXCPU ? ProcessEnd::kTimeLimit : ProcessEnd::kCrashed;
    return ProcessFailure{.end = end, .number = signal};
  }
  const int code = WEXITSTATUS(status);
  if (code == kExitDelivered) return std::nullopt;
  const auto end = code == kExitOutOfMemory ? ProcessEnd::kMemoryLimit : ProcessEnd::kFailed;
  return ProcessFailure{.end = end, .number = code};
}

tl::expected<ProcessOutput, ProcessFailure> mapOutput(int file) {
  struct stat status {};
  if (::fstat(file, &status) != 0) {
    return tl::unexpected(ProcessFailure{.end = ProcessEnd::kFailed, .number = errno});
  }
  const auto size = static_cast<std::size_t>(status.st_size);
  if (size == 0) return ProcessOutput({});
  void* address = ::mmap(nullptr, size, PROT_READ, MAP_SHARED, file, 0);
  if (address == MAP_FAILED) {
    return tl::unexpected(ProcessFailure{.end = ProcessEnd::kFailed, .number = errno});
  }
  return ProcessOutput({static_cast<const std::byte*>(address), size});
}

}  // namespace

ProcessOutput::~ProcessOutput() {
  if (!bytes_.empty()) ::munmap(const_cast<std::byte*>(bytes_.data()), bytes_.size());
}

ProcessOutput::ProcessOutput(ProcessOutput&& other) noexcept
    : bytes_(std::exchange(other.bytes_, {})) {}

ProcessOutput& ProcessOutput::operator=(ProcessOutput&& other) noexcept {
  std::swap(bytes_, other.bytes_);
  return *this;
}

tl::expected<ProcessOutput, ProcessFailure> runIsolated(const IsolatedWork& work,
                                                        const ProcessLimits& limits) {
  const auto not_started = [] { return tl::unexpected(ProcessFailure{.number = errno}); };
  const Descriptor file(::memfd_create("galactic-import", MFD_CLOEXEC));
  std::array<int, 2> ends{-1, -1};
  SharedStage stage;
  if (file.get() < 0 || !stage.valid() || ::pipe2(ends.data(), O_CLOEXEC) != 0)
    return not_started();
  const Descriptor read_end(ends[0]);
  Descriptor write_end(ends[1]);

  const pid_t child = ::fork();
  if (child < 0) return not_started();
  if (child == 0) {
    settleChild({file.get(), write_end.get()}, limits);
    MemoryFileChannel channel(file.get(), limits.memory, stage);
    runChild(work, channel);
  }
  write_end.reset();
  const auto killed_for = superviseChild(child, read_end.get(), limits);
  if (killed_for) ::kill(child, SIGKILL);
  auto failure = judgeExit(reapChild(child));
  if (killed_for) failure = ProcessFailure{.end = *killed_for, .number = SIGKILL};
  if (failure) {
    failure->stage = stage.get();
    return tl::unexpected(*failure);
  }
  return mapOutput(file.get());
}

}  // namespace galactic::bake
