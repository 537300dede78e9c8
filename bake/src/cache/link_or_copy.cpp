#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <system_error>

#include "cache/bake_cache.h"
#include "support/atomic_file.h"
#include "support/mapped_file.h"
#include "support/part_files.h"

namespace galactic::bake {
namespace {

namespace fs = std::filesystem;

/// Keeps others from taking `part`, a second name of a file, for a leftover, while it lives.
class HeldPart {
 public:
  explicit HeldPart(const fs::path& part)
      : descriptor_(::open(part.c_str(), O_RDONLY | O_CLOEXEC)) {
    is_there_ = descriptor_ >= 0 && holdPart(descriptor_, part);
  }
  ~HeldPart() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  HeldPart(const HeldPart&) = delete;
  HeldPart& operator=(const HeldPart&) = delete;
  HeldPart(HeldPart&&) = delete;
  HeldPart& operator=(HeldPart&&) = delete;
  [[nodiscard]] bool isThere() const { return is_there_; }

 private:
  int descriptor_;
  bool is_there_ = false;
};

enum class LinkEnd { kLinked, kImpossible, kFailed };

/// Gives `source` the name `target`, under which it appears at once. A second name of its own is
/// renamed, which replaces what is there.
LinkEnd linkOnto(const fs::path& source, const fs::path& target, std::error_code& problem) {
  constexpr unsigned kNames = 16;
  for (unsigned n = 0; n < kNames; ++n) {
    const fs::path part = partPathOf(target, n);
    fs::create_hard_link(source, part, problem);
    if (problem == std::errc::file_exists) {
      (void)removeStalePart(part);
      continue;
    }
    if (problem) return LinkEnd::kImpossible;
    const HeldPart held(part);
    if (!held.isThere()) continue;
    fs::rename(part, target, problem);
    // Renaming does nothing where another thread has just made the target the same file.
    std::error_code ignored;
    fs::remove(part, ignored);
    return problem ? LinkEnd::kFailed : LinkEnd::kLinked;
  }
  return LinkEnd::kImpossible;
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
