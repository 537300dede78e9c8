#include "support/files/atomic_file.h"

#include <fcntl.h>
#include <linux/magic.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <system_error>
#include <utility>

#include "support/files/part_files.h"
#include "support/try.h"

namespace galactic {

/// A part of the target, until it is published or removed.
class AtomicFile::Temporary {
 public:
  /// `path` is what the user named, `target` is where it leads.
  Temporary(std::filesystem::path path, std::filesystem::path target)
      : named_(std::move(path)), target_(std::move(target)), part_(target_) {}

  /// Why the part cannot be written; 0 if it can.
  [[nodiscard]] int error() const { return part_.error(); }

  [[nodiscard]] bool append(std::span<const std::byte> bytes) const {
    return writeAll(bytes, [this](std::span<const std::byte> rest) {
      return ::write(part_.descriptor(), rest.data(), rest.size());
    });
  }

  [[nodiscard]] bool overwrite(std::uint64_t offset, std::span<const std::byte> bytes) const {
    return writeAll(bytes, [&](std::span<const std::byte> rest) {
      const std::uint64_t done = bytes.size() - rest.size();
      return ::pwrite(part_.descriptor(), rest.data(), rest.size(),
                      static_cast<off_t>(offset + done));
    });
  }

  /// Makes the bytes durable, then visible under the target's name.
  [[nodiscard]] bool publish() const {
    if (::fsync(part_.descriptor()) != 0) return false;
    if (::rename(part_.path().c_str(), target_.c_str()) != 0) return false;
    syncFolder();
    return true;
  }

  /// `problem`: an error number; by default that of the last system call.
  [[nodiscard]] tl::unexpected<Error> failure(int problem = errno) const {
    return fail(ErrorCode::kIo, named_.string(),
                "cannot write the file: " + std::generic_category().message(problem) +
                    "; an existing file is left as it was");
  }

 private:
  template <class Write>
  static bool writeAll(std::span<const std::byte> bytes, const Write& write) {
    while (!bytes.empty()) {
      const ssize_t written = write(bytes);
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) return false;
      bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
    return true;
  }

  /// Makes the renaming durable; a file system that cannot do so has still renamed the file.
  void syncFolder() const {
    const std::filesystem::path folder = target_.has_parent_path() ? target_.parent_path() : ".";
    const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0) return;
    (void)::fsync(descriptor);
    ::close(descriptor);
  }

  std::filesystem::path named_;
  std::filesystem::path target_;
  PartFile part_;
};

AtomicFile::AtomicFile(std::unique_ptr<Temporary> temporary) : temporary_(std::move(temporary)) {}
AtomicFile::~AtomicFile() = default;
AtomicFile::AtomicFile(AtomicFile&&) noexcept = default;
AtomicFile& AtomicFile::operator=(AtomicFile&&) noexcept = default;

namespace {

/// Whether a link stands for a file that a process has open: /dev/stdout leads to /proc/self/fd/1,
/// and the file that this seems to point to may have been renamed or removed.
bool isOpenFile(const std::filesystem::path& link) {
  struct statfs system {};
  return ::statfs(link.parent_path().c_str(), &system) == 0 && system.f_type == PROC_SUPER_MAGIC;
}

}  // namespace

std::filesystem::path followLinks(const std::filesystem::path& path) {
  // As many links as Linux follows.
  constexpr int kMostLinks = 40;
  std::error_code none;
  std::filesystem::path target = path;
  for (int n = 0; n < kMostLinks && std::filesystem::is_symlink(target, none); ++n) {
    if (isOpenFile(target)) break;
    target = target.parent_path() / std::filesystem::read_symlink(target, none);
  }
  return target;
}

Result<AtomicFile> AtomicFile::create(const std::filesystem::path& path) {
  std::error_code unknown;
  // A link stays a link: the file that it points to is written.
  const std::filesystem::path target = followLinks(path);
  const bool is_link = std::filesystem::is_symlink(target, unknown);
  const auto status = std::filesystem::status(target, unknown);
  if (std::filesystem::is_other(status) || (is_link && isOpenFile(target))) {
    return fail(ErrorCode::kIo, path.string(),
                "cannot write the file: a device or pipe of this name is there; give another name");
  }
  if (is_link) {
    return fail(ErrorCode::kIo, path.string(),
                "cannot write the file: " + std::generic_category().message(ELOOP));
  }
  if (std::filesystem::is_directory(status)) {
    return fail(ErrorCode::kIo, path.string(),
                "cannot write the file: " + std::generic_category().message(EISDIR) +
                    "; an existing file is left as it was");
  }
  auto temporary = std::make_unique<Temporary>(path, target);
  if (temporary->error() != 0) return temporary->failure(temporary->error());
  return AtomicFile(std::move(temporary));
}

Result<void> AtomicFile::append(std::span<const std::byte> bytes) {
  if (!temporary_->append(bytes)) return temporary_->failure();
  return {};
}

Result<void> AtomicFile::overwrite(std::uint64_t offset, std::span<const std::byte> bytes) {
  if (!temporary_->overwrite(offset, bytes)) return temporary_->failure();
  return {};
}

Result<void> AtomicFile::publish() {
  if (!temporary_->publish()) return temporary_->failure();
  return {};
}

Result<void> writeFileAtomically(const std::filesystem::path& path,
                                 std::initializer_list<std::span<const std::byte>> parts) {
  ASSIGN_OR_RETURN(AtomicFile file, AtomicFile::create(path));
  for (const std::span<const std::byte>& part : parts) {
    if (auto appended = file.append(part); !appended) return appended;
  }
  return file.publish();
}

Result<void> writeFileAtomically(const std::filesystem::path& path, std::string_view text) {
  return writeFileAtomically(path, {std::as_bytes(std::span(text))});
}

}  // namespace galactic
