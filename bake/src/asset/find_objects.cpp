#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <optional>
#include <set>

#include "common/folder_entries.h"
#include "galactic/bake/assets.h"
#include "support/files/output_files.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

namespace fs = std::filesystem;

/// The mesh formats searched for in folders. If a model comes in several formats, the first one
/// listed here is taken.
constexpr std::array<std::string_view, 8> kMeshExtensions{".glb", ".gltf", ".obj", ".dae",
                                                          ".fbx", ".ply",  ".stl", ".off"};
/// Stems of files that stand for their whole folder.
constexpr std::array<std::string_view, 2> kFolderStems{"textured", "model"};

/// Prefixes of the stems of other forms beside such files in published sets: YCB's models without
/// texture or with fewer triangles, and collision meshes in one or several files.
constexpr std::array<std::string_view, 7> kOtherForms{
    "nontextured",     "textured_simple", "textured_collision", "textured.", "collision",
    "model_collision", "model."};

/// Names of folders that describe how a model was made and not what it is: those of YCB, best
/// first, and of Google Scanned Objects.
constexpr std::array<std::string_view, 7> kMakeFolders{
    "google_16k", "google_64k", "google_512k", "poisson", "tsdf", "meshes", "clouds"};

std::size_t makeRank(std::string_view folder) {
  return static_cast<std::size_t>(std::ranges::find(kMakeFolders, folder) - kMakeFolders.begin());
}

/// A model that stands for its folder.
struct FolderModel {
  ObjectInput input;
  /// Of several models of one object, the one with the lowest rank is taken.
  std::size_t rank = 0;
};

FolderModel modelOf(const fs::path& file) {
  const fs::path folder = fs::absolute(file).lexically_normal().parent_path();
  const std::size_t rank = makeRank(folder.filename().string());
  const bool is_made = rank < kMakeFolders.size();
  const std::string name = (is_made ? folder.parent_path() : folder).filename().string();
  // The root folder has no name.
  return {{file, name.empty() ? file.stem().string() : name}, is_made ? rank : 0};
}

std::size_t formatRank(const fs::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(), [](unsigned char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c + ('a' - 'A')) : static_cast<char>(c);
  });
  const auto* const found = std::find(kMeshExtensions.begin(), kMeshExtensions.end(), extension);
  return static_cast<std::size_t>(found - kMeshExtensions.begin());
}

bool isMesh(const fs::path& path) { return formatRank(path) < kMeshExtensions.size(); }

bool standsForFolder(const fs::path& path) {
  return std::find(kFolderStems.begin(), kFolderStems.end(), path.stem().string()) !=
         kFolderStems.end();
}

/// Whether a mesh is another form of the one beside it that stands for the folder.
bool isOtherForm(const fs::path& path) {
  const std::string stem = path.stem().string();
  const auto begins = [&](std::string_view form) { return stem.starts_with(form); };
  return standsForFolder(path) || std::ranges::any_of(kOtherForms, begins);
}

/// Finds the mesh files in a folder and below it.
class MeshSearch {
 public:
  explicit MeshSearch(const fs::path& root) : root_(canonicalPath(root)) {}

  /// Searches a folder. Links to folders are left for followLinks(), when it is known which folders
  /// can be reached without them.
  Result<void> search(const fs::path& folder) {
    if (!seen_.insert(canonicalPath(folder)).second) return {};
    ASSIGN_OR_RETURN(const auto entries, entriesOf(folder));
    for (const FolderEntry& entry : entries) {
      if (entry.kind == EntryKind::kFolder) {
        if (entry.is_link) {
          links_.push_back(entry.path);
          continue;
        }
        RETURN_IF_ERROR(search(entry.path));
      } else if (isMesh(entry.path)) {
        if (entry.kind == EntryKind::kLostLink) return lostLink(entry.path);
        if (entry.kind == EntryKind::kFile) folders_[folder].push_back(entry.path);
      }
    }
    return {};
  }

  /// Searches the folders behind links, except those that contain the root, which would lead
  /// outside it.
  Result<void> followLinks() {
    while (!links_.empty()) {
      std::vector<fs::path> links;
      links.swap(links_);
      for (const fs::path& link : links) {
        if (liesWithin(root_, canonicalPath(link))) continue;
        RETURN_IF_ERROR(search(link));
      }
    }
    return {};
  }

  /// The files found, in each folder in the order of formats and names.
  std::map<fs::path, std::vector<fs::path>> take() {
    for (auto& [folder, files] : folders_) {
      std::sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) {
        return std::pair(formatRank(a), a) < std::pair(formatRank(b), b);
      });
    }
    return std::move(folders_);
  }

 private:
  fs::path root_;
  /// Canonical paths, so that each folder is searched only once, even if it can be reached by
  /// several names.
  std::set<fs::path> seen_;
  std::vector<fs::path> links_;
  std::map<fs::path, std::vector<fs::path>> folders_;
};

/// The mesh files in `root` and each folder below it, in the order of formats and names.
Result<std::map<fs::path, std::vector<fs::path>>> meshesByFolder(const fs::path& root) {
  MeshSearch meshes(root);
  RETURN_IF_ERROR(meshes.search(root));
  RETURN_IF_ERROR(meshes.followLinks());
  return meshes.take();
}

constexpr std::string_view kVisual = "_visual";
constexpr std::string_view kCollision = "_collision";

/// NAME if `stem` is NAME followed by `end`, and both NAME_visual and NAME_collision but not NAME
/// itself are among `stems`. Gazebo lays out its models in this way.
std::optional<std::string> nameOfPair(const std::string& stem, std::string_view end,
                                      const std::set<std::string>& stems) {
  if (!stem.ends_with(end) || stem.size() == end.size()) return std::nullopt;
  std::string name = stem.substr(0, stem.size() - end.size());
  const bool is_pair = stems.contains(name + std::string(kVisual)) &&
                       stems.contains(name + std::string(kCollision)) && !stems.contains(name);
  return is_pair ? std::optional(std::move(name)) : std::nullopt;
}

/// Adds the objects of a folder in which no file stands for the whole folder, named by their stems.
/// Of a visual and a collision mesh that form a pair, the visual one becomes the object, because it
/// is more accurate.
void addStems(const std::vector<fs::path>& files, std::vector<ObjectInput>& objects) {
  std::set<std::string> stems;
  for (const fs::path& file : files) stems.insert(file.stem().string());
  std::set<std::string> taken;
  for (const fs::path& file : files) {
    const std::string stem = file.stem().string();
    if (nameOfPair(stem, kCollision, stems) || !taken.insert(stem).second) continue;
    objects.push_back({file, nameOfPair(stem, kVisual, stems).value_or(stem)});
  }
}

/// The warning about meshes that are left out because `model`, below `root`, stands for their
/// folder.
std::string leftOut(const fs::path& root, const fs::path& model,
                    const std::vector<fs::path>& hidden) {
  constexpr std::size_t kMostNamed = 6;
  // Relative paths, because warnings are stored in packs, which must not depend on the machine.
  std::vector<std::string> names;
  names.reserve(hidden.size());
  for (const fs::path& file : hidden) names.push_back(file.filename().string());
  const std::size_t more = names.size() - std::min(names.size(), kMostNamed);
  names.resize(names.size() - more);
  return fmt::format(
      "{} stands for all of its folder, and {}{} beside it {} left out: what is an "
      "object of its own needs a folder without such a file",
      model.lexically_relative(root).generic_string(), fmt::join(names, ", "),
      more == 0 ? "" : fmt::format(" and {} more", more), hidden.size() == 1 ? "is" : "are");
}

Result<void> addFolder(const fs::path& root, FoundObjects& found) {
  ASSIGN_OR_RETURN(const auto folders, meshesByFolder(root));
  if (folders.empty()) {
    return fail(ErrorCode::kInvalidInput, root.string(),
                "holds no mesh file; .glb, .gltf, .obj, .dae, .fbx, .ply, .stl and .off are looked "
                "for");
  }
  // One model per object, by the folder that the object is named after.
  std::map<fs::path, FolderModel> models;
  for (const auto& [folder, files] : folders) {
    const auto whole = std::find_if(files.begin(), files.end(), standsForFolder);
    if (whole == files.end()) {
      addStems(files, found.objects);
      continue;
    }
    std::vector<fs::path> others;
    std::ranges::remove_copy_if(files, std::back_inserter(others), isOtherForm);
    // A user who names this folder itself means all objects in it.
    if (folder == root && !others.empty()) {
      others.push_back(*whole);
      addStems(others, found.objects);
      continue;
    }
    if (!others.empty()) found.warnings.push_back(leftOut(root, *whole, others));
    FolderModel model = modelOf(*whole);
    const bool is_made = makeRank(folder.filename().string()) < kMakeFolders.size();
    const auto [known, is_new] = models.try_emplace(is_made ? folder.parent_path() : folder, model);
    if (!is_new && model.rank < known->second.rank) known->second = std::move(model);
  }
  for (auto& [folder, model] : models) found.objects.push_back(std::move(model.input));
  return {};
}

}  // namespace

Result<FoundObjects> findObjects(const std::vector<fs::path>& inputs) {
  FoundObjects found;
  std::vector<ObjectInput>& objects = found.objects;
  for (const fs::path& input : inputs) {
    if (!isFolder(input)) {
      // The object gets the same name as if its folder had been searched.
      objects.push_back(standsForFolder(input) ? modelOf(input).input
                                               : ObjectInput{input, input.stem().string()});
      continue;
    }
    RETURN_IF_ERROR(addFolder(input, found));
  }
  std::sort(objects.begin(), objects.end(), [](const ObjectInput& a, const ObjectInput& b) {
    return std::tie(a.name, a.path) < std::tie(b.name, b.path);
  });
  const auto same = std::adjacent_find(
      objects.begin(), objects.end(),
      [](const ObjectInput& a, const ObjectInput& b) { return a.name == b.name; });
  if (same != objects.end()) {
    return fail(ErrorCode::kInvalidInput, std::next(same)->path.string(),
                fmt::format("would be the object '{}', as {} is; rename one of them", same->name,
                            same->path.string()));
  }
  return found;
}

}  // namespace galactic::bake
