#include "cache/bake_cache.h"

#include <algorithm>
#include <span>
#include <system_error>
#include <utility>

#include "cache/cache_entry.h"
#include "support/files/atomic_file.h"
#include "support/files/output_files.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kEntrySuffix = ".json";

std::string hexOf(std::string_view text) {
  return hexOf(describeBytes({}, std::as_bytes(std::span(text))));
}

/// The entry files of a key, newest first; equally old ones by name.
std::vector<fs::path> entriesIn(const fs::path& folder) {
  std::vector<std::pair<fs::file_time_type, fs::path>> dated;
  std::error_code problem;
  for (fs::directory_iterator at(folder, problem), end; !problem && at != end;
       at.increment(problem)) {
    if (at->path().extension() != kEntrySuffix) continue;
    std::error_code gone;
    const auto time = fs::last_write_time(at->path(), gone);
    if (!gone) dated.emplace_back(time, at->path());
  }
  std::sort(dated.begin(), dated.end(), [](const auto& a, const auto& b) {
    return a.first != b.first ? a.first > b.first : a.second < b.second;
  });
  std::vector<fs::path> paths;
  paths.reserve(dated.size());
  for (auto& [time, path] : dated) paths.push_back(std::move(path));
  return paths;
}

fs::path packBeside(const fs::path& entry) {
  fs::path pack = entry;
  return pack.replace_extension(".pack");
}

/// Whether the pack is still as it was stored. Users could have changed it, as a hard link shares
/// its bytes.
bool isIntact(const fs::path& pack, const SourceFile& digest) {
  const auto found = describeFile(pack);
  return found && sameContent(*found, digest);
}

void removeOldEntries(const fs::path& folder) {
  const std::vector<fs::path> entries = entriesIn(folder);
  std::error_code ignored;
  for (std::size_t n = BakeCache::kResultsPerKey; n < entries.size(); ++n) {
    fs::remove(entries[n], ignored);
    fs::remove(packBeside(entries[n]), ignored);
  }
}

}  // namespace

std::optional<CachedBake> BakeCache::find(const std::string& key, const fs::path& folder,
                                          FileDigests& digests) const {
  for (const fs::path& path : entriesIn(folder_ / hexOf(key))) {
    auto entry = readCacheEntry(path);
    if (!entry || entry->inputs.key != key || !digests.areAsRead(entry->inputs.read, folder)) {
      continue;
    }
    CachedBake found{packBeside(path), entry->pack, std::move(entry->figures)};
    if (isIntact(found.pack, found.digest)) return found;
  }
  return std::nullopt;
}

Result<void> BakeCache::store(const BakeInputs& inputs, const fs::path& pack,
                              const PackFigures& figures) const {
  ASSIGN_OR_RETURN(auto digest, describeFile(pack));
  const std::string text = encodeCacheEntry({inputs, digest, figures});
  // The name depends only on the inputs, not on times and paths in the figures.
  const std::string name = hexOf(encodeCacheEntry({inputs, {}, {}}));
  const fs::path folder = folder_ / hexOf(inputs.key);
  RETURN_IF_ERROR(makeFolders(folder));
  const fs::path entry = folder / (name + std::string(kEntrySuffix));
  // Store the pack first, because an entry is invalid without it.
  if (auto kept = linkOrCopy(pack, packBeside(entry)); !kept) return kept;
  if (auto written = writeFileAtomically(entry, text); !written) {
    return written;
  }
  removeOldEntries(folder);
  return {};
}

}  // namespace galactic::bake
