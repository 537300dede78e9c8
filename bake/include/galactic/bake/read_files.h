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

/// Size and XXH3-128 hash of the file at `path`, for a pack's provenance. Its name is the file's
/// own: the path would tell of the machine. Fails with kIo where it cannot be read.
[[nodiscard]] Result<SourceFile> describeFile(const std::filesystem::path& path);

/// The same of a file that is in memory.
[[nodiscard]] SourceFile describeBytes(std::string name, std::span<const std::byte> bytes);

/// 32 hexadecimal digits of the content's hash.
[[nodiscard]] std::string hexOf(const SourceFile& file);

/// Whatever their names.
[[nodiscard]] inline bool sameContent(const SourceFile& a, const SourceFile& b) {
  return a.bytes == b.bytes && a.hash_low == b.hash_low && a.hash_high == b.hash_high;
}

/// What something was read from: while these files are as they were, the same is read again.
struct ReadFiles {
  std::vector<SourceFile> files;
  /// Names of files and folders that were looked for and are not there: once they are, something
  /// else may be read.
  std::vector<std::string> absent{};
  /// Whether `files` and `absent` are all that decides it.
  bool is_settled = true;
};

}  // namespace galactic::bake
