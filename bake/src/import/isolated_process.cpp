#include "import/isolated_process.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
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

#include "galactic/error.h"

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
constexpr int kPipeBytes = 1 << 20;
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

/// A word of memory that parent and child share.
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

/// The child's end of the pipe. Unlike with a file in memory, what goes through a pipe counts
/// against no limit on file sizes.
class PipeChannel final : public ProcessChannel {
 public:
  PipeChannel(int pipe_end, std::uint64_t limit, SharedStage& stage)
      : pipe_end_(pipe_end), left_(limit), stage_(stage) {
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
      const ssize_t written = ::write(pipe_end_, bytes.data(), bytes.size());
      if (written < 0 && errno == EINTR) continue;
      if (written <= 0) ::_exit(kExitOutput);
      bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
  }

  int pipe_end_;
  std::uint64_t left_;
  SharedStage& stage_;
  std::vector<std::byte> buffer_;
};

/// The bytes received from the pipe so far, in memory that grows.
class ReceivedBytes {
 public:
  ReceivedBytes() = default;
  ~ReceivedBytes() {
    if (capacity_ > 0) ::munmap(memory_, capacity_);
  }
  ReceivedBytes(const ReceivedBytes&) = delete;
  ReceivedBytes& operator=(const ReceivedBytes&) = delete;
  ReceivedBytes(ReceivedBytes&&) = delete;
  ReceivedBytes& operator=(ReceivedBytes&&) = delete;

  /// Receives what the pipe holds: returns the number of bytes, 0 at the end, or -1 with errno.
  ssize_t receive(int pipe_end) {
    if (size_ == capacity_ && !grow()) return -1;
    const ssize_t count =
        ::read(pipe_end, static_cast<std::byte*>(memory_) + size_, capacity_ - size_);
    if (count > 0) size_ += static_cast<std::size_t>(count);
    return count;
  }

  [[nodiscard]] std::size_t size() const { return size_; }

  /// Passes the ownership of the bytes on.
  ProcessOutput take() {
    if (capacity_ == 0) return ProcessOutput({});
    const std::size_t page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
    const std::size_t used = (size_ + page - 1) / page * page;
    if (used < capacity_) ::munmap(static_cast<std::byte*>(memory_) + used, capacity_ - used);
    capacity_ = 0;
    return ProcessOutput({static_cast<const std::byte*>(memory_), size_});
  }

 private:
  bool grow() {
    const std::size_t wanted = std::max(kBufferBytes, 2 * capacity_);
    void* grown = capacity_ == 0 ? ::mmap(nullptr, wanted, PROT_READ | PROT_WRITE,
                                          MAP_PRIVATE | MAP_ANONYMOUS, -1, 0)
                                 : ::mremap(memory_, capacity_, wanted, MREMAP_MAYMOVE);
    if (grown == MAP_FAILED) return false;
    memory_ = grown;
    capacity_ = wanted;
    return true;
  }

  void* memory_ = nullptr;
  std::size_t size_ = 0;
  std::size_t capacity_ = 0;
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

void limitResource(Resource resource, std::uint64_t value, std::uint64_t grace = 0) {
  rlimit limit{};
  if (::getrlimit(resource, &limit) != 0) return;
  limit = {std::min<rlim_t>(value, limit.rlim_max),
           std::min<rlim_t>(value + grace, limit.rlim_max)};
  ::setrlimit(resource, &limit);
}

/// Makes the child harmless: it dies with its parent, handles no signals, holds no descriptor
/// except `kept`, and prints nothing.
void settleChild(int kept, pid_t parent, const ProcessLimits& limits) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  // If the parent ended before this call, no signal will come.
  if (::getppid() != parent) ::_exit(kExitException);
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGTRAP, SIGALRM, SIGXCPU,
                           SIGPIPE, SIGUSR1, SIGUSR2}) {
    std::signal(signal, SIG_DFL);
  }
  // Terminals and schedulers signal a whole process group; the parent finishes what it has begun.
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT}) std::signal(signal, SIG_IGN);
  sigset_t none;
  ::sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  const int nowhere = ::open("/dev/null", O_RDWR);
  for (const int stream : {0, 1, 2}) ::dup2(nowhere, stream);
  // Closes other children's pipes, too, so that nobody waits for this child by mistake.
  if (kept > 3) ::close_range(3, static_cast<unsigned>(kept) - 1, 0);
  ::close_range(static_cast<unsigned>(kept) + 1, ~0U, 0);

  limitResource(RLIMIT_CORE, 0);
  const auto seconds = std::chrono::ceil<std::chrono::seconds>(limits.wall_clock).count();
  // Later than the wall clock's limit, which gives a clearer message.
  constexpr std::int64_t kGraceSeconds = 5;
  // The soft limit sends SIGXCPU, the hard one SIGKILL, which says nothing about the reason.
  limitResource(RLIMIT_CPU, static_cast<std::uint64_t>(seconds + kGraceSeconds), kGraceSeconds);
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

[[noreturn]] void runChild(const IsolatedWork& work, PipeChannel& channel) {
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

/// Watches the child's memory in place of a limit on its address space, which sanitizers use up
/// themselves.
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

/// Receives what the child sends until it closes its end of the pipe. Returns the reason if it must
/// be killed.
std::optional<ProcessFailure> superviseChild(pid_t child, int pipe_end, const ProcessLimits& limits,
                                             ReceivedBytes& received) {
  const auto killed_for = [](ProcessEnd end) {
    return ProcessFailure{.end = end, .number = SIGKILL};
  };
  const auto deadline = std::chrono::steady_clock::now() + limits.wall_clock;
  const MemoryWatch memory(limits);
  while (true) {
    const auto left =
        std::chrono::ceil<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now());
    if (left.count() <= 0) return killed_for(ProcessEnd::kTimeLimit);
    if (memory.exceededBy(child)) return killed_for(ProcessEnd::kMemoryLimit);
    const auto longest = kUnderSanitizer ? kWatchIntervalMs : 1'000'000;
    pollfd waiting{pipe_end, POLLIN, 0};
    int done = ::poll(&waiting, 1, static_cast<int>(std::min<std::int64_t>(left.count(), longest)));
    if (done > 0) {
      const ssize_t count = received.receive(pipe_end);
      if (count == 0) return std::nullopt;
      // The child keeps to this limit by itself, unless its input has taken control of it.
      if (received.size() > limits.memory) return killed_for(ProcessEnd::kMemoryLimit);
      done = count < 0 ? -1 : 1;
    }
    if (done < 0 && errno == ENOMEM) return killed_for(ProcessEnd::kMemoryLimit);
    if (done < 0 && errno != EINTR) return killed_for(ProcessEnd::kFailed);
  }
}

int reapChild(pid_t child) {
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

/// For a child that was killed by the machine or by somebody, and not for anything it did.
[[noreturn]] void throwKilled() {
  throw ErrorException(
      {ErrorCode::kUnsupported, "a process that reads files",
       "was killed from outside, as the system does where memory runs out; free some, or bake less "
       "at once (`threads`, `memory`), and give the command again"});
}

std::optional<ProcessFailure> judgeExit(int status) {
  if (WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    if (signal == SIGKILL) throwKilled();
    const auto end = signal == SIGXCPU ? ProcessEnd::kTimeLimit : ProcessEnd::kCrashed;
    return ProcessFailure{.end = end, .number = signal};
  }
  const int code = WEXITSTATUS(status);
  if (code == kExitDelivered) return std::nullopt;
  const auto end = code == kExitOutOfMemory ? ProcessEnd::kMemoryLimit : ProcessEnd::kFailed;
  return ProcessFailure{.end = end, .number = code};
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
  std::array<int, 2> ends{-1, -1};
  SharedStage stage;
  if (!stage.valid() || ::pipe2(ends.data(), O_CLOEXEC) != 0) return not_started();
  const Descriptor read_end(ends[0]);
  Descriptor write_end(ends[1]);
  // A larger pipe saves switches between the processes; if this fails, there are just more of them.
  (void)::fcntl(write_end.get(), F_SETPIPE_SZ, kPipeBytes);

  const pid_t parent = ::getpid();
  const pid_t child = ::fork();
  if (child < 0) return not_started();
  if (child == 0) {
    settleChild(write_end.get(), parent, limits);
    PipeChannel channel(write_end.get(), limits.memory, stage);
    runChild(work, channel);
  }
  write_end.reset();
  ReceivedBytes received;
  auto failure = superviseChild(child, read_end.get(), limits, received);
  if (failure) ::kill(child, SIGKILL);
  const int status = reapChild(child);
  if (!failure) failure = judgeExit(status);
  if (failure) {
    failure->stage = stage.get();
    return tl::unexpected(*failure);
  }
  return received.take();
}

std::uint64_t ownMemoryLimit() {
  rlimit limit{};
  return ::getrlimit(RLIMIT_AS, &limit) == 0 ? limit.rlim_cur : RLIM_INFINITY;
}

}  // namespace galactic::bake
