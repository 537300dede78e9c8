#include "cache/file_digests.h"

#include <algorithm>
#include <system_error>
#include <utility>

namespace galactic::bake {
namespace {

/// The same spelling for all paths to a file, except through links.
std::filesystem::path plain(const std::filesystem::path& file) {
  std::error_code problem;
  const auto absolute = std::filesystem::absolute(file, problem);
  return (problem ? file : absolute).lexically_normal();
}

}  // namespace

Result<SourceFile> FileDigests::of(const std::filesystem::path& file) {
  const std::filesystem::path key = plain(file);
  {
    const std::lock_guard lock(mutex_);
    const auto found = known_.find(key);
    if (found != known_.end()) return found->second;
  }
  // Outside the lock, so that other files need not wait. Two threads may read the same file.
  Result<SourceFile> digest = describeFile(key);
  if (digest) digest->name = file.generic_string();
  const std::lock_guard lock(mutex_);
  return known_.try_emplace(key, std::move(digest)).first->second;
}

bool FileDigests::areAsRead(const ReadFiles& read, const std::filesystem::path& folder) {
  const auto is_absent = [&](const std::string& name) {
    std::error_code problem;
    return !std::filesystem::exists(folder / name, problem);
  };
  const auto is_same = [&](const SourceFile& file) {
    const auto now = of(folder / file.name);
    return now && sameContent(*now, file);
  };
  return std::ranges::all_of(read.absent, is_absent) && std::ranges::all_of(read.files, is_same);
}

}  // namespace galactic::bake
