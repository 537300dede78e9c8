#include <fmt/format.h>
#include <unistd.h>

#include <system_error>

#include "galactic/bake/bake_cache.h"

namespace galactic::bake {

Result<void> linkOrCopy(const std::filesystem::path& source, const std::filesystem::path& target) {
  namespace fs = std::filesystem;
  std::error_code problem;
  if (fs::equivalent(source, target, problem)) return {};
  // A name of this thread alone, then renamed: never half a file.
  const fs::path temporary = target.string() + fmt::format(".part-{}", ::gettid());
  fs::remove(temporary, problem);
  fs::create_hard_link(source, temporary, problem);
  if (problem) {
    problem.clear();
    fs::copy_file(source, temporary, problem);
  }
  if (!problem) fs::rename(temporary, target, problem);
  // Renaming does nothing where another thread has just made the target the same file.
  std::error_code ignored;
  fs::remove(temporary, ignored);
  if (!problem) return {};
  return fail(ErrorCode::kIo, target.string(),
              fmt::format("cannot write the file: {}; an existing file is left as it was",
                          problem.message()));
}

}  // namespace galactic::bake
