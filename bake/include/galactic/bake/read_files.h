#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "galactic/error.h"

namespace galactic::bake {

/// One file that was read.
struct SourceFile {
  /// Relative to the folder of the main input.
  std::string name;
  std::uint64_t bytes = 0;
  std::uint64_t hash_low = 0;
  std::uint64_t hash_high = 0;
};

/// Size and XXH3-128 hash of the file at `path`, for a pack's provenance. Its name has no folders,
/// because a path would reveal something about the machine. Fails with kIo if the file cannot be
/// read.
[[nodiscard]] Result<SourceFile> describeFile(const std::filesystem::path& path);

/// The same for a file in memory.
[[nodiscard]] SourceFile describeBytes(std::string name, std::span<const std::byte> bytes);

/// The content's hash as 32 hexadecimal digits.
[[nodiscard]] std::string hexOf(const SourceFile& file);

/// Whether two files have the same content, whatever their names.
[[nodiscard]] inline bool sameContent(const SourceFile& a, const SourceFile& b) {
  return a.bytes == b.bytes && a.hash_low == b.hash_low && a.hash_high == b.hash_high;
}

/// The files from which something was read: as long as they do not change, reading again gives the
/// same.
struct ReadFiles {
  std::vector<SourceFile> files;
  /// Names of files and folders that were looked for and do not exist. If one of them appears,
  /// reading may give something else.
  std::vector<std::string> absent{};
  /// Whether the result depends on nothing but `files` and `absent`.
  bool is_settled = true;
};

}  // namespace galactic::bake
