#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <memory>
#include <span>
#include <string_view>

#include "galactic/error.h"

namespace galactic {

/// The path that `path` leads to through symbolic links, whether or not a file exists there. Still
/// a link if the links form a circle or lead to a file that a process has open (/dev/stdout).
[[nodiscard]] std::filesystem::path followLinks(const std::filesystem::path& path);

/// A file that is written piece by piece and appears only when it is whole: it grows under another
/// name beside its path, and is renamed at the end. A symbolic link is followed; a folder, device
/// or pipe is refused, and so is a path that leads to an open file, as /dev/stdout does. If it is
/// destroyed before it is published, it leaves nothing behind and does not touch an existing file
/// of that name. All failures are kIo.
class AtomicFile {
 public:
  [[nodiscard]] static Result<AtomicFile> create(const std::filesystem::path& path);
  ~AtomicFile();
  AtomicFile(AtomicFile&&) noexcept;
  AtomicFile& operator=(AtomicFile&&) noexcept;

  [[nodiscard]] Result<void> append(std::span<const std::byte> bytes);
  /// Replaces bytes that were appended earlier.
  [[nodiscard]] Result<void> overwrite(std::uint64_t offset, std::span<const std::byte> bytes);
  /// Makes the bytes durable (fsync), then visible under the path: the last call.
  [[nodiscard]] Result<void> publish();

 private:
  class Temporary;
  explicit AtomicFile(std::unique_ptr<Temporary> temporary);
  std::unique_ptr<Temporary> temporary_;
};

/// Writes `parts` one after the other to `path` as an AtomicFile: a reader sees the old file or the
/// new one, never half of it. On failure (kIo) the old file is intact and nothing else is left.
[[nodiscard]] Result<void> writeFileAtomically(
    const std::filesystem::path& path, std::initializer_list<std::span<const std::byte>> parts);
/// The same for a text.
[[nodiscard]] Result<void> writeFileAtomically(const std::filesystem::path& path,
                                               std::string_view text);

}  // namespace galactic
