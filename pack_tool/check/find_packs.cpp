#include "pack_tool/check/find_packs.h"

#include <algorithm>

#include "support/files/output_files.h"

namespace galactic::pack_tool {

namespace fs = std::filesystem;

Result<std::vector<fs::path>> findPacks(const fs::path& folder) {
  std::vector<fs::path> packs;
  std::error_code problem;
  fs::recursive_directory_iterator entry(folder, problem);
  for (; !problem && entry != fs::recursive_directory_iterator(); entry.increment(problem)) {
    std::error_code ignored;
    // Such as the cache of bakes, which may be deleted at any time.
    if (entry->path().filename().string().starts_with('.')) {
      entry.disable_recursion_pending();
      continue;
    }
    if (extensionOf(entry->path()) == ".pack" && !entry->is_directory(ignored)) {
      packs.push_back(entry->path());
    }
  }
  if (problem) {
    return fail(ErrorCode::kIo, folder.string(), "cannot read the folder: " + problem.message(),
                "file/unreadable");
  }
  if (packs.empty()) {
    return fail(ErrorCode::kInvalidInput, folder.string(),
                "has no files *.pack in it or below; give packs, or a folder with packs",
                "file/no-packs");
  }
  std::sort(packs.begin(), packs.end());
  return packs;
}

}  // namespace galactic::pack_tool
