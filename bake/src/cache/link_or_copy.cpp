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

/// Gives `source` the name `target`, under which it appears at once. A second name of its own is
/// renamed, which replaces what is there.
LinkEnd linkOnto(const fs::path& source, const fs::path& target, std::error_code& problem) {
  // Renaming does nothing where another thread has just made the target the same file; then the
  // part goes at the end.
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
