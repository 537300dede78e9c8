#include <fmt/format.h>

#include <system_error>

#include "cache/bake_cache.h"
#include "support/files/atomic_file.h"
#include "support/files/mapped_file.h"
#include "support/files/part_files.h"

namespace galactic::bake {
namespace {

namespace fs = std::filesystem;

enum class LinkEnd { kLinked, kImpossible, kFailed };

/// Atomically makes `target` a hard link to `source`: creates a link with a temporary name and
/// renames it, which replaces an existing `target`.
LinkEnd linkOnto(const fs::path& source, const fs::path& target, std::error_code& problem) {
  // If another thread has just made the target the same file, renaming does nothing, and the
  // destructor removes the part.
  const PartFile part = PartFile::linkedTo(source, target);
  if (part.error() != 0) return LinkEnd::kImpossible;
  fs::rename(part.path(), target, problem);
  return problem ? LinkEnd::kFailed : LinkEnd::kLinked;
}

tl::unexpected<Error> failure(const fs::path& target, const std::string& why) {
  return fail(ErrorCode::kIo, target.string(),
              fmt::format("cannot write the file: {}; an existing file is left as it was", why));
}

}  // namespace

Result<void> linkOrCopy(const fs::path& source, const fs::path& target) {
  std::error_code problem;
  if (fs::equivalent(source, target, problem)) return {};
  const LinkEnd end = linkOnto(source, target, problem);
  if (end == LinkEnd::kLinked) return {};
  if (end == LinkEnd::kFailed) return failure(target, problem.message());
  const auto content = MappedFile::open(source);
  if (!content) {
    return failure(target, fmt::format("{}: {}", source.string(), content.error().message));
  }
  return writeFileAtomically(target, {content->bytes()});
}

}  // namespace galactic::bake
