#include "support/files/mapped_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

namespace galactic {
namespace {

tl::unexpected<Error> ioFailure(const std::filesystem::path& path, const char* action) {
  return fail(ErrorCode::kIo, path.string(),
              std::string("cannot ") + action + ": " + std::generic_category().message(errno),
              "file/unreadable");
}

}  // namespace

Result<MappedFile> MappedFile::open(const std::filesystem::path& path) {
  // O_NONBLOCK, because opening a pipe would wait for its writer.
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) return ioFailure(path, "open the file");
  struct stat status {};
  if (::fstat(descriptor, &status) != 0) {
    auto failure = ioFailure(path, "read the file's size");
    ::close(descriptor);
    return failure;
  }
  if (!S_ISREG(status.st_mode)) {
    ::close(descriptor);
    return fail(ErrorCode::kIo, path.string(), "is not a regular file; give the path of a file",
                "file/not-regular");
  }
  const auto size = static_cast<std::size_t>(status.st_size);
  if (size == 0) {
    ::close(descriptor);
    return MappedFile({});
  }
  void* address = ::mmap(nullptr, size, PROT_READ, MAP_SHARED, descriptor, 0);
  if (address == MAP_FAILED) {
    auto failure = ioFailure(path, "map the file");
    ::close(descriptor);
    return failure;
  }
  ::close(descriptor);
  return MappedFile({static_cast<const std::byte*>(address), size});
}

MappedFile::~MappedFile() {
  if (!bytes_.empty()) ::munmap(const_cast<std::byte*>(bytes_.data()), bytes_.size());
}

MappedFile::MappedFile(MappedFile&& other) noexcept : bytes_(std::exchange(other.bytes_, {})) {}

MappedFile& MappedFile::operator=(MappedFile&& other) noexcept {
  std::swap(bytes_, other.bytes_);
  return *this;
}

}  // namespace galactic
