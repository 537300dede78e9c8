#include "support/files/output_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <system_error>

#include "support/files/atomic_file.h"
#include "support/files/part_files.h"
#include "support/try.h"

namespace galactic {

namespace fs = std::filesystem;

bool isThere(const fs::path& path) {
  std::error_code unknown;
  return fs::exists(path, unknown);
}

bool isFolder(const fs::path& path) {
  std::error_code unknown;
  return fs::is_directory(path, unknown);
}

bool isSameFile(const fs::path& a, const fs::path& b) {
  std::error_code missing;
  if (fs::equivalent(a, b, missing)) return true;
  if (fs::exists(a, missing) || fs::exists(b, missing)) return false;
  // Without this, a relative name of which nothing exists would stay relative.
  const auto where_it_would_be = [&missing](const fs::path& path) {
    return fs::weakly_canonical(fs::absolute(followLinks(path), missing), missing);
  };
  const fs::path place = where_it_would_be(a);
  return !place.empty() && place == where_it_would_be(b);
}

Result<void> checkNotInput(const fs::path& output, const fs::path& input) {
  if (!isSameFile(output, input)) return {};
  return fail(ErrorCode::kInvalidInput, output.string(), "is also an input; write to another file");
}

Result<void> checkOutputs(std::span<const OutputFile> outputs, std::span<const fs::path> inputs) {
  for (auto one = outputs.begin(); one != outputs.end(); ++one) {
    for (const fs::path& input : inputs) RETURN_IF_ERROR(checkNotInput(one->file, input));
    for (auto other = outputs.begin(); other != one; ++other) {
      if (one->option == other->option || !isSameFile(one->file, other->file)) continue;
      return fail(ErrorCode::kInvalidInput, one->file.string(),
                  fmt::format("would be written twice: by {} and by {}; give each its own name",
                              other->option, one->option));
    }
  }
  return {};
}

std::string extensionOf(const fs::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

Result<void> checkNotDash(const fs::path& output) {
  if (output != "-") return {};
  return fail(
      ErrorCode::kIo, output.string(),
      "is not the standard output here; give a file's name, or ./- for a file of that name");
}

Result<void> checkExtension(const fs::path& output, const FileKind& kind) {
  RETURN_IF_ERROR(checkNotDash(output));
  const std::string extension = extensionOf(output);
  const bool is_short = !extension.empty() && extension == kind.short_extension;
  if (extension == kind.extension || is_short) return {};
  return fail(ErrorCode::kUnsupported, output.string(),
              fmt::format("{}; end the name with {}", kind.sentence, kind.extension));
}

Result<void> makeFolders(const fs::path& folder) {
  std::error_code problem;
  if (!folder.empty()) fs::create_directories(folder, problem);
  if (!problem) return {};
  return fail(ErrorCode::kIo, folder.string(), "cannot be made a folder: " + problem.message());
}

Result<void> tryFile(const fs::path& path) {
  RETURN_IF_ERROR(checkNotDash(path));
  RETURN_IF_ERROR(AtomicFile::create(path));
  // Some thousand names are listed in milliseconds; a folder of millions, perhaps on a network,
  // would hold up short work.
  constexpr std::size_t kMostNames = 30'000;
  const fs::path target = followLinks(path);
  (void)removeStaleParts(target.parent_path(),
                         {.target = target.filename().string(), .most_names = kMostNames});
  return {};
}

}  // namespace galactic
