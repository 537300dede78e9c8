#include "dataset/dataset_paths.h"

#include <fnmatch.h>

#include <algorithm>
#include <system_error>

namespace galactic::bake {
namespace {

namespace fs = std::filesystem;

bool isPattern(const std::string& part) { return part.find_first_of("*?[") != std::string::npos; }

/// Everything in `folder`, ascending.
std::vector<fs::path> entriesOf(const fs::path& folder) {
  std::vector<fs::path> entries;
  std::error_code error;
  fs::directory_iterator entry(folder, fs::directory_options::skip_permission_denied, error);
  while (!error && entry != fs::directory_iterator()) {
    entries.push_back(entry->path());
    entry.increment(error);
  }
  std::sort(entries.begin(), entries.end());
  return entries;
}

/// The matches of one part of a pattern in each of `folders`.
std::vector<fs::path> step(const std::vector<fs::path>& folders, const std::string& part) {
  std::vector<fs::path> matches;
  std::error_code ignored;
  for (const fs::path& folder : folders) {
    if (!isPattern(part)) {
      if (fs::exists(folder / part, ignored)) matches.push_back(folder / part);
      continue;
    }
    for (fs::path& entry : entriesOf(folder)) {
      const std::string name = entry.filename().string();
      if (::fnmatch(part.c_str(), name.c_str(), FNM_PERIOD) == 0) {
        matches.push_back(std::move(entry));
      }
    }
  }
  return matches;
}

}  // namespace

std::vector<fs::path> matchingPaths(const fs::path& folder, const std::string& pattern) {
  const fs::path parts(pattern);
  std::vector<fs::path> matches{parts.is_absolute() ? parts.root_path() : folder};
  for (const fs::path& part : parts.relative_path()) {
    if (!part.empty()) matches = step(matches, part.string());
  }
  const bool folders_only = pattern.ends_with('/');
  std::vector<fs::path> found;
  found.reserve(matches.size());
  std::error_code ignored;
  for (const fs::path& match : matches) {
    if (folders_only && !fs::is_directory(match, ignored)) continue;
    fs::path normal = match.lexically_normal();
    if (!normal.has_filename()) normal = normal.parent_path();
    found.push_back(std::move(normal));
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

std::vector<fs::path> filesIn(const fs::path& folder, std::string_view suffix) {
  std::vector<fs::path> files;
  std::error_code ignored;
  for (fs::path& entry : entriesOf(folder)) {
    if (!entry.filename().string().ends_with(suffix)) continue;
    if (fs::is_regular_file(entry, ignored)) files.push_back(std::move(entry));
  }
  return files;
}

std::string lowerCase(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return lower;
}

}  // namespace galactic::bake
