#include "support/output_files.h"

#include <system_error>

#include "support/atomic_file.h"
#include "support/try.h"

namespace galactic {

namespace fs = std::filesystem;

bool isSameFile(const fs::path& a, const fs::path& b) {
  std::error_code missing;
  if (fs::equivalent(a, b, missing)) return true;
  if (fs::exists(a, missing) || fs::exists(b, missing)) return false;
  // A relative name of which nothing exists would stay relative.
  const auto where_it_would_be = [&missing](const fs::path& path) {
    return fs::weakly_canonical(fs::absolute(path, missing), missing);
  };
  const fs::path place = where_it_would_be(a);
  return !place.empty() && place == where_it_would_be(b);
}

Result<void> checkNotInput(const fs::path& output, const fs::path& input) {
  if (!isSameFile(output, input)) return {};
  return fail(ErrorCode::kInvalidInput, output.string(), "is also an input; write to another file");
}

Result<void> tryFile(const fs::path& path) {
  RETURN_IF_ERROR(AtomicFile::create(path));
  return {};
}

}  // namespace galactic
