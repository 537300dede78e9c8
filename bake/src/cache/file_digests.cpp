#include "cache/file_digests.h"

#include <system_error>
#include <utility>

#include "galactic/bake/source_asset.h"

namespace galactic::bake {
namespace {

/// One spelling for one file.
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
  // Outside of the lock: other files need not wait. Two threads may read the same one.
  Result<SourceFile> digest = describeFile(key);
  if (digest) digest->name = file.generic_string();
  const std::lock_guard lock(mutex_);
  return known_.try_emplace(key, std::move(digest)).first->second;
}

}  // namespace galactic::bake
