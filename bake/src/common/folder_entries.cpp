#include "common/folder_entries.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

namespace galactic::bake {
namespace {

namespace fs = std::filesystem;

EntryKind kindOf(const fs::directory_entry& entry, bool is_link) {
  std::error_code unknown;
  const fs::file_status status = entry.status(unknown);
  if (fs::is_regular_file(status)) return EntryKind::kFile;
  if (fs::is_directory(status)) return EntryKind::kFolder;
  return is_link && !fs::exists(status) ? EntryKind::kLostLink : EntryKind::kOther;
}

}  // namespace

Result<std::vector<FolderEntry>> entriesOf(const fs::path& folder) {
  std::vector<FolderEntry> entries;
  std::error_code problem;
  fs::directory_iterator entry(folder, problem);
  for (; !problem && entry != fs::directory_iterator(); entry.increment(problem)) {
    if (entry->path().filename().string().starts_with('.')) continue;
    std::error_code unknown;
    const bool is_link = entry->is_symlink(unknown);
    entries.push_back({entry->path(), kindOf(*entry, is_link), is_link});
  }
  if (problem) {
    return fail(ErrorCode::kIo, folder.string(),
                fmt::format("the folder cannot be read: {}", problem.message()));
  }
  std::ranges::sort(entries, {}, &FolderEntry::path);
  return entries;
}

tl::unexpected<Error> lostLink(const fs::path& link) {
  std::error_code unknown;
  const fs::path target = fs::read_symlink(link, unknown);
  return fail(ErrorCode::kIo, link.string(),
              fmt::format("is a link to {}, which is not there or cannot be looked at; restore "
                          "that file, or remove the link",
                          target.string()));
}

fs::path canonicalPath(const fs::path& path) {
  std::error_code problem;
  // Make it absolute first, because a relative path of which nothing exists would stay relative.
  fs::path canonical = fs::weakly_canonical(fs::absolute(path, problem), problem);
  if (problem) return path.lexically_normal();
  return canonical.has_filename() ? canonical : canonical.parent_path();
}

bool liesWithin(const fs::path& inner, const fs::path& outer) {
  const fs::path relative = inner.lexically_relative(outer);
  return !relative.empty() && *relative.begin() != "..";
}

}  // namespace galactic::bake
