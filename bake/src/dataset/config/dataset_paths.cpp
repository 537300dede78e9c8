#include "dataset/config/dataset_paths.h"

#include <algorithm>
#include <system_error>

namespace galactic::bake {
namespace {

namespace fs = std::filesystem;

/// Where the set that begins at `start` of `pattern` ends: the index of its ']'. None: no set.
std::optional<std::size_t> endOfSet(std::string_view pattern, std::size_t start) {
  std::size_t first = start + 1;
  if (first < pattern.size() && (pattern[first] == '!' || pattern[first] == '^')) ++first;
  // A ']' that comes first belongs to the set.
  const std::size_t end = pattern.find(']', first + 1);
  if (end == std::string_view::npos) return std::nullopt;
  return end;
}

/// `set` is what stands between the brackets.
bool isInSet(char c, std::string_view set) {
  const bool inverted = set.front() == '!' || set.front() == '^';
  if (inverted) set.remove_prefix(1);
  const auto code = [](char letter) { return static_cast<unsigned char>(letter); };
  bool found = false;
  for (std::size_t i = 0; i < set.size(); ++i) {
    if (i + 2 < set.size() && set[i + 1] == '-') {
      found = found || (code(set[i]) <= code(c) && code(c) <= code(set[i + 2]));
      i += 2;
    } else {
      found = found || set[i] == c;
    }
  }
  return found != inverted;
}

/// The part of the pattern behind what takes `c`; none where nothing does.
std::optional<std::size_t> behind(std::string_view pattern, std::size_t at, char c) {
  if (at >= pattern.size()) return std::nullopt;
  if (pattern[at] == '[') {
    if (const auto end = endOfSet(pattern, at)) {
      if (!isInSet(c, pattern.substr(at + 1, *end - at - 1))) return std::nullopt;
      return *end + 1;
    }
  }
  if (pattern[at] != '?' && pattern[at] != c) return std::nullopt;
  return at + 1;
}

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

/// The matches of one part of a pattern in each of `folders`; more than kMostMatches are cut off.
std::vector<fs::path> step(const std::vector<fs::path>& folders, const std::string& part) {
  std::vector<fs::path> matches;
  std::error_code ignored;
  for (const fs::path& folder : folders) {
    if (!isPattern(part)) {
      if (fs::exists(folder / part, ignored)) matches.push_back(folder / part);
      continue;
    }
    for (fs::path& entry : entriesOf(folder)) {
      if (matchesPattern(entry.filename().string(), part)) matches.push_back(std::move(entry));
    }
    if (matches.size() > kMostMatches) return matches;
  }
  return matches;
}

}  // namespace

bool matchesPattern(std::string_view name, std::string_view pattern) {
  if (name.starts_with('.') && !pattern.starts_with('.')) return false;
  std::size_t at = 0;
  std::size_t taken = 0;
  // Of the last '*': behind it in the pattern, and up to where it takes the name. An earlier one
  // never has to take more: what follows it matched already.
  std::optional<std::size_t> star;
  std::size_t star_taken = 0;
  while (taken < name.size()) {
    if (at < pattern.size() && pattern[at] == '*') {
      star = ++at;
      star_taken = taken;
    } else if (const auto next = behind(pattern, at, name[taken])) {
      at = *next;
      ++taken;
    } else if (star) {
      at = *star;
      taken = ++star_taken;
    } else {
      return false;
    }
  }
  return pattern.find_first_not_of('*', at) == std::string_view::npos;
}

std::optional<std::vector<fs::path>> matchingPaths(const fs::path& folder,
                                                   const std::string& pattern) {
  const fs::path parts(pattern);
  std::vector<fs::path> matches{parts.is_absolute() ? parts.root_path() : folder};
  for (const fs::path& part : parts.relative_path()) {
    if (!part.empty()) matches = step(matches, part.string());
    if (matches.size() > kMostMatches) return std::nullopt;
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

}  // namespace galactic::bake
