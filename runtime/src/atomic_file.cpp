#include "galactic/atomic_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <system_error>

namespace galactic {
namespace {

/// A file under a name of its own beside the target, removed unless it was renamed onto the target.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::filesystem::path& target)
      : target_(target), path_(target.string() + ".part-" + std::to_string(::getpid())) {
    // Exclusive, so that it neither follows a link nor shares a file; a leftover of a killed
    // process with the same number makes way.
    constexpr int kFlags = O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC;
    descriptor_ = ::open(path_.c_str(), kFlags, 0666);
    if (descriptor_ < 0 && errno == EEXIST && ::unlink(path_.c_str()) == 0) {
      descriptor_ = ::open(path_.c_str(), kFlags, 0666);
    }
  }
  ~TemporaryFile() {
    if (descriptor_ < 0) return;
    ::close(descriptor_);
    if (!renamed_) ::unlink(path_.c_str());
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  [[nodiscard]] bool isOpen() const { return descriptor_ >= 0; }

  [[nodiscard]] bool write(std::span<const std::byte> bytes) const {
    while (!bytes.empty()) {
      const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) return false;
      bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
    return true;
  }

  /// Makes the bytes durable, then visible under the target's name.
  [[nodiscard]] bool publish() {
    if (::fsync(descriptor_) != 0) return false;
    renamed_ = ::rename(path_.c_str(), target_.c_str()) == 0;
    if (renamed_) syncFolder();
    return renamed_;
  }

 private:
  /// Makes the renaming durable; a file system that cannot do so has still renamed the file.
  void syncFolder() const {
    const std::filesystem::path folder = target_.has_parent_path() ? target_.parent_path() : ".";
    const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0) return;
    (void)::fsync(descriptor);
    ::close(descriptor);
  }

  std::filesystem::path target_;
  std::string path_;
  int descriptor_ = -1;
  bool renamed_ = false;
};

tl::unexpected<Error> writeFailure(const std::filesystem::path& path) {
  return fail(ErrorCode::kIo, path.string(),
              "cannot write the file: " + std::generic_category().message(errno) +
                  "; an existing file is left as it was");
}

}  // namespace

Result<void> writeFileAtomically(const std::filesystem::path& path,
                                 std::initializer_list<std::span<const std::byte>> parts) {
  std::error_code unknown;
  // A link stays a link: what it points to is written.
  const bool is_link = std::filesystem::is_symlink(path, unknown);
  const std::filesystem::path target =
      is_link ? std::filesystem::weakly_canonical(path, unknown) : path;
  const auto status = std::filesystem::status(target, unknown);
  if (std::filesystem::is_other(status)) {
    return fail(ErrorCode::kIo, path.string(),
                "cannot write the file: a device or pipe of this name is there; give another name");
  }
  TemporaryFile file(target);
  if (!file.isOpen()) return writeFailure(path);
  for (const std::span<const std::byte>& part : parts) {
    if (!file.write(part)) return writeFailure(path);
  }
  if (!file.publish()) return writeFailure(path);
  return {};
}

}  // namespace galactic
