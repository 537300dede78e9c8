#include "pack_tool/output_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <string>
#include <system_error>

namespace galactic::pack_tool {

namespace {

/// A file under a name of its own that vanishes unless it is renamed.
class TemporaryFile {
 public:
  /// Creates the file beside `target`; ok() tells whether that worked, errno why not.
  explicit TemporaryFile(const std::filesystem::path& target)
      : name_(target.string() + ".XXXXXX"), descriptor_(mkostemp(name_.data(), O_CLOEXEC)) {}
  ~TemporaryFile() {
    if (descriptor_ < 0) return;
    close(descriptor_);
    if (!renamed_) unlink(name_.c_str());
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  [[nodiscard]] bool ok() const { return descriptor_ >= 0; }

  /// Writes everything and gets it to the disk; errno tells why not.
  [[nodiscard]] bool fill(std::string_view bytes) {
    while (!bytes.empty()) {
      const ssize_t written = write(descriptor_, bytes.data(), bytes.size());
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) return false;
      bytes.remove_prefix(static_cast<std::size_t>(written));
    }
    // mkostemp makes files that only the owner may read; a picture is for everyone.
    return fchmod(descriptor_, S_IRUSR | S_IWUSR | S_IRGRP | S_IROTH) == 0 &&
           fsync(descriptor_) == 0;
  }

  [[nodiscard]] bool renameTo(const std::filesystem::path& target) {
    renamed_ = rename(name_.c_str(), target.c_str()) == 0;
    return renamed_;
  }

 private:
  std::string name_;
  int descriptor_ = -1;
  bool renamed_ = false;
};

}  // namespace

Result<void> writeOutputFile(const std::filesystem::path& path, std::string_view bytes) {
  const auto failed = [&path](std::string_view what) {
    return fail(ErrorCode::kIo, path.string(),
                fmt::format("cannot {}: {}; check that the folder exists, is writable and has room",
                            what, std::generic_category().message(errno)));
  };
  TemporaryFile file(path);
  if (!file.ok()) return failed("create a file beside it");
  if (!file.fill(bytes)) return failed(fmt::format("write {} bytes", bytes.size()));
  if (!file.renameTo(path)) return failed("put the finished file in its place");
  return {};
}

}  // namespace galactic::pack_tool
