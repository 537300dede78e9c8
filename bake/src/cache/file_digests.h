#pragma once
#include <filesystem>
#include <map>
#include <mutex>

#include "galactic/bake/read_files.h"
#include "galactic/error.h"

namespace galactic::bake {

/// Sizes and hashes of files, each file read once however often it is asked for: what a file held
/// when it was first looked at is what counts for the whole run. Thread-safe.
class FileDigests {
 public:
  /// Its name is the path as given. Fails with kIo where the file cannot be read, each time.
  [[nodiscard]] Result<SourceFile> of(const std::filesystem::path& file);

  /// Whether the files below `folder` hold what was read, and what was absent still is.
  [[nodiscard]] bool areAsRead(const ReadFiles& read, const std::filesystem::path& folder);

 private:
  std::mutex mutex_;
  std::map<std::filesystem::path, Result<SourceFile>> known_;
};

}  // namespace galactic::bake
