#pragma once
#include <cstddef>
#include <filesystem>
#include <span>

#include "galactic/error.h"

namespace galactic {

/// A file mapped read-only into memory and shared through the page cache. Movable, not copyable.
class MappedFile {
 public:
  /// Maps `path`. Fails with kIo when it cannot be opened or is not a regular file.
  [[nodiscard]] static Result<MappedFile> open(const std::filesystem::path& path);

  ~MappedFile();
  MappedFile(MappedFile&& other) noexcept;
  MappedFile& operator=(MappedFile&& other) noexcept;
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  /// The file's bytes, page-aligned; empty for an empty file. Valid as long as this object lives.
  [[nodiscard]] std::span<const std::byte> bytes() const { return bytes_; }

 private:
  explicit MappedFile(std::span<const std::byte> bytes) : bytes_(bytes) {}

  std::span<const std::byte> bytes_;
};

}  // namespace galactic
