#pragma once
#include <filesystem>
#include <map>
#include <mutex>

#include "galactic/bake/read_files.h"
#include "galactic/error.h"

namespace galactic::bake {

/// Sizes and hashes of files. Each file is read only once, so the content at the first look counts
/// for the whole run. Thread-safe.
class FileDigests {
 public:
  /// The result's name is the path as given. Fails with kIo, on every call, if the file cannot be
  /// read.
  [[nodiscard]] Result<SourceFile> of(const std::filesystem::path& file);

  /// Whether the files below `folder` still hold what was read, and absent files are still absent.
  [[nodiscard]] bool areAsRead(const ReadFiles& read, const std::filesystem::path& folder);

 private:
  std::mutex mutex_;
  std::map<std::filesystem::path, Result<SourceFile>> known_;
};

}  // namespace galactic::bake
