#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <system_error>
#include <utility>

#include "recipe/world_recipe.h"

namespace galactic::bake {
namespace {

namespace fs = std::filesystem;

bool isPattern(std::string_view part) { return part.find_first_of("*?") != std::string_view::npos; }

/// The paths in any of `folders` that match one part of a pattern.
std::vector<fs::path> step(const std::vector<fs::path>& folders, const fs::path& part) {
  std::vector<fs::path> found;
  const std::string name = part.string();
  for (const fs::path& folder : folders) {
    std::error_code problem;
    if (!isPattern(name)) {
      if (fs::exists(folder / part, problem)) found.push_back(folder / part);
      continue;
    }
    for (fs::directory_iterator at(folder, problem), end; !problem && at != end;
         at.increment(problem)) {
      const std::string candidate = at->path().filename().string();
      // As in a shell, the pattern must spell a leading dot.
      if (candidate.front() == '.' && name.front() != '.') continue;
      if (fitsPattern(candidate, name)) found.push_back(at->path());
    }
  }
  return found;
}

bool isEmptyFolder(const fs::path& path) {
  std::error_code unknown;
  return fs::is_directory(path, unknown) && fs::is_empty(path, unknown);
}

std::vector<fs::path> matches(const fs::path& root, const fs::path& pattern) {
  const fs::path start = pattern.is_absolute() ? pattern.root_path() : root;
  std::vector<fs::path> found{start};
  for (const fs::path& part : pattern.relative_path()) {
    // The last part is empty after a trailing slash.
    if (!part.empty()) found = step(found, part);
  }
  return found;
}

}  // namespace

bool fitsPattern(std::string_view text, std::string_view pattern) {
  // The usual algorithm: after a mismatch, the last star takes one character more.
  std::size_t at = 0;
  std::size_t in_pattern = 0;
  std::size_t star = std::string_view::npos;
  std::size_t after_star = 0;
  while (at < text.size()) {
    if (in_pattern < pattern.size() && pattern[in_pattern] == '*') {
      star = in_pattern++;
      after_star = at;
    } else if (in_pattern < pattern.size() &&
               (pattern[in_pattern] == '?' || pattern[in_pattern] == text[at])) {
      ++in_pattern;
      ++at;
    } else if (star != std::string_view::npos) {
      in_pattern = star + 1;
      at = ++after_star;
    } else {
      return false;
    }
  }
  return pattern.find_first_not_of('*', in_pattern) == std::string_view::npos;
}

Result<std::vector<fs::path>> findInputs(const std::vector<std::string>& patterns,
                                         const std::vector<fs::path>& roots) {
  std::vector<fs::path> found;
  for (const std::string& pattern : patterns) {
    std::vector<fs::path> matched;
    for (const fs::path& root : roots) {
      std::vector<fs::path> here = matches(root, pattern);
      if (here.empty()) continue;
      // The first root with a match wins, but an empty folder does not hide what other roots have.
      const bool is_empty = std::ranges::all_of(here, isEmptyFolder);
      if (matched.empty() || !is_empty) matched = std::move(here);
      if (!is_empty) break;
    }
    if (matched.empty()) {
      std::string looked;
      for (const fs::path& root : roots) looked += (looked.empty() ? "" : " or ") + root.string();
      return fail(ErrorCode::kIo, pattern,
                  fmt::format("fits no file in {}; correct it, or tell with `data` where the files "
                              "are",
                              looked));
    }
    found.insert(found.end(), matched.begin(), matched.end());
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

}  // namespace galactic::bake
