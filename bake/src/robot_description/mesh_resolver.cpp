#include "robot_description/mesh_resolver.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <optional>
#include <string_view>
#include <system_error>

#include "common/lower_case.h"
#include "import/source_files.h"

namespace galactic::bake {
namespace {

namespace fs = std::filesystem;

/// Depth below a search root to which packages are looked for, and the greatest number of folders.
constexpr int kSearchDepth = 4;
constexpr std::size_t kMostSearchedFolders = 20'000;
/// A package.xml is small; of a larger one only this much is read.
constexpr std::size_t kPackageFileBytes = 65'536;

/// In the folder of `path`, the first name that differs from its name only in upper and lower case;
/// empty if there is none.
std::string fileInOtherCase(const fs::path& path) {
  const std::string wanted = path.filename().string();
  std::string found;
  std::error_code error;
  for (fs::directory_iterator entry(path.parent_path(), error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    const bool differs_in_case = name != wanted && lowerCase(name) == lowerCase(wanted);
    if (differs_in_case && (found.empty() || name < found)) found = name;
  }
  return found;
}

fs::path packageFileOf(const fs::path& folder) { return folder / "package.xml"; }

/// The name in the first <name> of a package.xml, found without a parser.
std::string nameInPackageFile(const fs::path& folder) {
  std::ifstream stream(packageFileOf(folder), std::ios::binary);
  if (!stream) return {};
  std::string text(kPackageFileBytes, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(stream.gcount()));
  constexpr std::string_view kOpen = "<name>";
  const std::size_t open = text.find(kOpen);
  if (open == std::string::npos) return {};
  const std::size_t close = text.find("</name>", open);
  if (close == std::string::npos) return {};
  std::string name = text.substr(open + kOpen.size(), close - open - kOpen.size());
  constexpr const char* kBlanks = " \t\r\n";
  const std::size_t first = name.find_first_not_of(kBlanks);
  if (first == std::string::npos) return {};
  return name.substr(first, name.find_last_not_of(kBlanks) - first + 1);
}

bool isPackage(const fs::path& folder, const std::string& package) {
  return folder.filename() == package || nameInPackageFile(folder) == package;
}

/// The folders directly in `folder`, sorted by name; without hidden ones.
std::vector<fs::path> foldersIn(const fs::path& folder) {
  std::vector<fs::path> folders;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const bool hidden = entry->path().filename().string().starts_with('.');
    std::error_code ignored;
    if (!hidden && entry->is_directory(ignored)) folders.push_back(entry->path());
  }
  std::sort(folders.begin(), folders.end());
  return folders;
}

/// Package folders at or below `root`, nearest first.
void searchPackage(const fs::path& root, const std::string& package, std::vector<fs::path>& found) {
  std::vector<fs::path> level{root};
  std::size_t searched = 0;
  for (int depth = 0; depth <= kSearchDepth && !level.empty(); ++depth) {
    std::vector<fs::path> next;
    for (const fs::path& folder : level) {
      if (++searched > kMostSearchedFolders) return;
      if (isPackage(folder, package)) found.push_back(folder);
      if (depth == kSearchDepth) continue;
      for (fs::path& below : foldersIn(folder)) next.push_back(std::move(below));
    }
    level = std::move(next);
  }
}

}  // namespace

MeshResolver::MeshResolver(const fs::path& path, const RobotImportOptions& options)
    : options_(options) {
  std::error_code ignored;
  fs::path folder = fs::absolute(path, ignored).lexically_normal().parent_path();
  while (true) {
    ancestors_.push_back(folder);
    if (folder == folder.parent_path()) break;
    folder = folder.parent_path();
  }
}

std::optional<fs::path> MeshResolver::fileIn(const fs::path& folder, const std::string& name) {
  std::vector<std::string> spellings{name, withoutUriEscapes(name)};
  for (std::size_t i = 0; i < 2; ++i) {
    std::string& spelling = spellings.emplace_back(spellings[i]);
    std::replace(spelling.begin(), spelling.end(), '\\', '/');
  }
  for (const std::string& spelling : spellings) {
    fs::path path = (folder / spelling).lexically_normal();
    if (search_.findsFile(path)) return path;
  }
  return std::nullopt;
}

bool MeshResolver::findsPackageFile(const fs::path& folder) {
  const fs::path file = packageFileOf(folder);
  if (!search_.findsFile(file) || !std::ifstream(file)) return false;
  package_files_.insert(file);
  return true;
}

bool MeshResolver::isPackageAbove(const fs::path& folder, const std::string& package) {
  return folder.filename() == package ||
         (findsPackageFile(folder) && nameInPackageFile(folder) == package);
}

const std::vector<fs::path>& MeshResolver::foldersOf(const std::string& package) {
  const auto [entry, is_new] = folders_of_package_.try_emplace(package);
  if (is_new) {
    for (const fs::path& root : options_.search_roots) {
      // Tries the usual case first, which avoids a search through a whole installation.
      if (search_.findsFolder(root / package)) entry->second.push_back(root / package);
    }
    if (entry->second.empty()) {
      has_searched_ = !options_.search_roots.empty() || has_searched_;
      for (const fs::path& root : options_.search_roots) {
        searchPackage(root, package, entry->second);
      }
    }
  }
  return entry->second;
}

MeshResolution MeshResolver::notFound(const std::vector<fs::path>& tried) const {
  constexpr std::size_t kMostNamed = 6;
  std::vector<std::string> places;
  // Uses relative paths, because packs contain the warnings, and must not depend on the machine.
  for (const fs::path& path : tried) {
    std::string place = path.lexically_relative(ancestors_.front()).generic_string();
    const bool is_new = std::find(places.begin(), places.end(), place) == places.end();
    if (is_new) places.push_back(std::move(place));
  }
  std::string other_case;
  for (const fs::path& path : tried) {
    if (other_case.empty()) other_case = fileInOtherCase(path);
  }
  if (!other_case.empty()) {
    other_case = fmt::format(", where '{}' differs in upper and lower case", other_case);
  }
  const std::size_t left = places.size() - std::min(places.size(), kMostNamed);
  places.resize(places.size() - left);
  return {.file = {},
          .how = fmt::format("{}{} (from the robot's folder){}", fmt::join(places, ", "),
                             left == 0 ? "" : fmt::format(" and {} more", left), other_case),
          .guessed = false};
}

bool MeshResolver::isInReach(const fs::path& path) {
  if (options_.allow_outside || isBelow(path, ancestors_.front() / "..")) return true;
  const auto is_in = [&](const fs::path& folder) { return isBelow(path, folder); };
  const auto is_in_package = [&](const auto& package) { return is_in(package.second); };
  return std::any_of(options_.packages.begin(), options_.packages.end(), is_in_package) ||
         std::any_of(options_.search_roots.begin(), options_.search_roots.end(), is_in) ||
         std::any_of(ancestors_.begin(), ancestors_.end(), [&](const fs::path& ancestor) {
           return is_in(ancestor) && findsPackageFile(ancestor);
         });
}

std::optional<MeshResolution> MeshResolver::resolveIn(const fs::path& folder, Wanted& wanted,
                                                      std::string how) {
  if (auto file = fileIn(folder, wanted.rest);
      file && (isBelow(*file, folder) || isInReach(*file))) {
    return MeshResolution{.file = *file, .how = std::move(how), .guessed = false};
  }
  std::error_code ignored;
  wanted.tried.push_back(fs::absolute(folder / wanted.rest, ignored).lexically_normal());
  return std::nullopt;
}

std::optional<MeshResolution> MeshResolver::resolveAbove(Wanted& wanted) {
  for (const fs::path& ancestor : ancestors_) {
    if (isPackageAbove(ancestor, wanted.package)) {
      if (auto found = resolveIn(ancestor, wanted, "package above the robot's file")) return found;
    }
    const fs::path beside = ancestor / wanted.package;
    if (search_.findsFolder(beside)) {
      if (auto found = resolveIn(beside, wanted, "package beside the robot's folders"))
        return found;
    }
  }
  return guessAbove(
      wanted.rest,
      fmt::format("no package '{}'; by its path from above the robot's file", wanted.package));
}

std::optional<MeshResolution> MeshResolver::guessAbove(const std::string& name, std::string how) {
  std::optional<fs::path> far;
  for (const fs::path& ancestor : ancestors_) {
    auto file = fileIn(ancestor, name);
    if (!file) continue;
    if (isInReach(*file)) {
      return MeshResolution{.file = *std::move(file), .how = std::move(how), .guessed = true};
    }
    if (!far) far = std::move(file);
  }
  if (!far) return std::nullopt;
  return outOfReach(*far);
}

MeshResolution MeshResolver::outOfReach(const fs::path& file) const {
  MeshResolution resolution = notFound({file});
  resolution.how +=
      ", which is there, but outside the robot's folders and packages; give `package` NAME=DIR or "
      "`allow-outside`";
  return resolution;
}

MeshResolution MeshResolver::resolvePackage(const std::string& package, const std::string& rest) {
  Wanted wanted{.package = package, .rest = rest, .tried = {}};
  const auto named = options_.packages.find(package);
  if (named != options_.packages.end()) {
    const std::string how = fmt::format("`package` {}", package);
    if (auto found = resolveIn(named->second, wanted, how)) return *found;
  }
  for (const fs::path& folder : foldersOf(package)) {
    if (auto found = resolveIn(folder, wanted, "package search path")) return *found;
  }
  if (auto found = resolveAbove(wanted)) return *found;
  if (!wanted.tried.empty()) return notFound(wanted.tried);
  return {.file = {},
          .how = fmt::format("a folder '{}' or a package.xml of that name in the search path and "
                             "above the robot's file",
                             package),
          .guessed = false};
}

MeshResolution MeshResolver::resolveRelative(const std::string& reference) {
  const fs::path path(reference);
  if (path.empty()) return {.file = {}, .how = "a file name, which is empty", .guessed = false};
  if (path.is_absolute()) {
    const auto file = fileIn("/", reference);
    if (!file) return notFound({path.lexically_normal()});
    if (!isInReach(*file)) return outOfReach(*file);
    return {.file = *file, .how = "absolute path"};
  }
  if (auto file = fileIn(ancestors_.front(), reference)) {
    if (!isInReach(*file)) return outOfReach(*file);
    return {.file = *file, .how = "relative to the robot's file"};
  }
  if (*path.begin() != "..") {
    if (auto found = guessAbove(reference, "relative to a folder above the robot's file")) {
      return *found;
    }
  }
  return notFound({(ancestors_.front() / reference).lexically_normal()});
}

MeshResolution MeshResolver::resolve(const std::string& reference) {
  for (const std::string_view scheme : {"package://", "model://"}) {
    if (!reference.starts_with(scheme)) continue;
    std::string path = reference.substr(scheme.size());
    // Some files have package:///pkg/a.stl.
    path.erase(0, std::min(path.find_first_not_of('/'), path.size()));
    const std::size_t slash = path.find('/');
    if (slash == std::string::npos) return resolveRelative(path.empty() ? reference : path);
    return resolvePackage(path.substr(0, slash), path.substr(slash + 1));
  }
  constexpr std::string_view kFile = "file://";
  if (reference.starts_with(kFile)) return resolveRelative(reference.substr(kFile.size()));
  return resolveRelative(reference);
}

}  // namespace galactic::bake
