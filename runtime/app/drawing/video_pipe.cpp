#include "drawing/video_pipe.h"

#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <optional>
#include <span>
#include <sstream>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "support/files/part_files.h"

namespace galactic {
namespace {

using pictures::Image;

tl::unexpected<Error> failure(const std::filesystem::path& path, const std::string& message) {
  return fail(ErrorCode::kIo, path.string(), message);
}

/// Whether a folder of PATH that can be read contains a file of this name.
bool isOnPath(const std::string& program) {
  const char* const path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "" : path);
  std::string folder;
  std::error_code unknown;
  while (std::getline(folders, folder, ':')) {
    if (std::filesystem::is_regular_file(folder / std::filesystem::path(program), unknown)) {
      return true;
    }
  }
  return false;
}

std::string textOf(int error) { return std::generic_category().message(error); }

/// How a child process is set up: it reads from `input`, and the terminal's Ctrl-C does not reach
/// it.
class SpawnSetup {
 public:
  explicit SpawnSetup(int input) {
    posix_spawn_file_actions_init(&actions_);
    posix_spawn_file_actions_adddup2(&actions_, input, STDIN_FILENO);
    posix_spawnattr_init(&attributes_);
    sigset_t none;
    sigemptyset(&none);
    posix_spawnattr_setsigmask(&attributes_, &none);
    posix_spawnattr_setpgroup(&attributes_, 0);
    posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETPGROUP);
  }
  ~SpawnSetup() {
    posix_spawn_file_actions_destroy(&actions_);
    posix_spawnattr_destroy(&attributes_);
  }
  SpawnSetup(const SpawnSetup&) = delete;
  SpawnSetup& operator=(const SpawnSetup&) = delete;
  SpawnSetup(SpawnSetup&&) = delete;
  SpawnSetup& operator=(SpawnSetup&&) = delete;

  /// Starts argv[0] from PATH; returns the error number, 0 if there is none.
  int start(std::vector<std::string> arguments, pid_t& child) const {
    std::vector<char*> argv;
    argv.reserve(arguments.size() + 1);
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    return posix_spawnp(&child, argv[0], &actions_, &attributes_, argv.data(), environ);
  }

 private:
  posix_spawn_file_actions_t actions_{};
  posix_spawnattr_t attributes_{};
};

std::vector<std::string> ffmpegCommand(const std::filesystem::path& path, const Image& like) {
  return {"ffmpeg", "-y", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgb24", "-s",
          fmt::format("{}x{}", like.width(), like.height()), "-r", std::to_string(VideoPipe::kRate),
          "-i", "-", "-an", "-pix_fmt",
          // Prevents a path from being read as an option or a protocol.
          "yuv420p", (path.is_absolute() ? path : "." / path).string()};
}

}  // namespace

class VideoPipe::Child {
 public:
  explicit Child(const std::filesystem::path& path) : path_(path) {}
  ~Child() { (void)waitForEnd(); }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  Child(Child&&) = delete;
  Child& operator=(Child&&) = delete;

  Result<void> start(const Image& like) {
    if (path_.extension().empty()) {
      return fail(ErrorCode::kInvalidInput, path_.string(),
                  "has no ending that tells ffmpeg the format; name it, for example, run.mp4");
    }
    (void)removeStaleParts(path_.parent_path(), {.target = path_.filename().string()});
    // Keep the extension, by which ffmpeg chooses the format.
    part_.emplace(path_, PartEnding::kOfTarget);
    if (part_->error() != 0) return failure(path_, "cannot be written: " + textOf(part_->error()));
    // Unlike a pipe, a socket can be set to raise no signal when nobody reads from it.
    std::array<int, 2> ends{-1, -1};
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
      return failure(path_, "cannot make a pipe to ffmpeg: " + textOf(errno));
    }
    const SpawnSetup setup(ends[0]);
    const int error = setup.start(ffmpegCommand(part_->path(), like), pid_);
    close(ends[0]);
    socket_ = ends[1];
    if (error == 0) return {};
    pid_ = 0;
    closeSocket();
    // A folder of PATH that cannot be read causes EACCES even if there is no ffmpeg.
    if (error == ENOENT || (error == EACCES && !isOnPath("ffmpeg"))) {
      return fail(ErrorCode::kUnsupported, path_.string(),
                  "needs ffmpeg, which is not on PATH; install it, or take --frames instead");
    }
    return failure(path_, "cannot start ffmpeg: " + textOf(error));
  }

  Result<void> append(const Image& frame) {
    std::span<const std::byte> bytes = std::as_bytes(std::span(frame.pixels()));
    while (!bytes.empty()) {
      const ssize_t sent = send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (sent < 0 && errno == EINTR) continue;
      const bool has_ended = sent < 0 && (errno == EPIPE || errno == ECONNRESET);
      if (has_ended) return endedBadly(waitForEnd());
      if (sent < 0) return failure(path_, "cannot send to ffmpeg: " + textOf(errno));
      bytes = bytes.subspan(static_cast<std::size_t>(sent));
    }
    return {};
  }

  Result<void> finish() {
    const int status = waitForEnd();
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) return endedBadly(status);
    std::error_code error;
    std::filesystem::rename(part_->path(), path_, error);
    if (!error) return {};
    return failure(path_, "cannot be written: " + error.message());
  }

 private:
  void closeSocket() {
    if (socket_ >= 0) close(std::exchange(socket_, -1));
  }

  /// Lets the child end; returns its status.
  int waitForEnd() {
    closeSocket();
    int status = 0;
    while (pid_ > 0 && waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
    }
    pid_ = 0;
    return status;
  }

  tl::unexpected<Error> endedBadly(int status) {
    part_.reset();
    const std::string how = WIFEXITED(status) ? fmt::format("with code {}", WEXITSTATUS(status))
                                              : fmt::format("by signal {}", WTERMSIG(status));
    return failure(path_, fmt::format("ffmpeg ended {} before the video was whole; what it says "
                                      "stands above",
                                      how));
  }

  std::filesystem::path path_;
  std::optional<PartFile> part_;
  int socket_ = -1;
  pid_t pid_ = 0;
};

VideoPipe::VideoPipe(std::unique_ptr<Child> child) : child_(std::move(child)) {}
VideoPipe::~VideoPipe() = default;
VideoPipe::VideoPipe(VideoPipe&&) noexcept = default;
VideoPipe& VideoPipe::operator=(VideoPipe&&) noexcept = default;

Result<VideoPipe> VideoPipe::start(const std::filesystem::path& path, const Image& like) {
  auto child = std::make_unique<Child>(path);
  if (Result<void> started = child->start(like); !started) {
    return tl::unexpected<Error>(started.error());
  }
  return VideoPipe(std::move(child));
}

Result<void> VideoPipe::append(const Image& frame) { return child_->append(frame); }
Result<void> VideoPipe::finish() { return child_->finish(); }

}  // namespace galactic
