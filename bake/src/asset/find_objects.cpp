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

/// The mesh formats searched for in folders; of one model in several, the first of them is taken.
constexpr std::array<std::string_view, 8> kMeshExtensions{".glb", ".gltf", ".obj", ".dae",
                                                          ".fbx", ".ply",  ".stl", ".off"};
/// Files that stand for their whole folder.
constexpr std::array<std::string_view, 2> kFolderStems{"textured", "model"};

/// How the stems of what lies beside such files begin in published sets: YCB's models without
/// texture or with fewer triangles, and parts for collision, in a file or in several.
constexpr std::array<std::string_view, 7> kOtherForms{
    "nontextured",     "textured_simple", "textured_collision", "textured.", "collision",
    "model_collision", "model."};

/// Folders that say how a model was made, not what it is: YCB's, the best first, and Google Scanned
/// Objects'.
constexpr std::array<std::string_view, 7> kMakeFolders{
    "google_16k", "google_64k", "google_512k", "poisson", "tsdf", "meshes", "clouds"};

std::size_t makeRank(std::string_view folder) {
  return static_cast<std::size_t>(std::ranges::find(kMakeFolders, folder) - kMakeFolders.begin());
}

/// A model that stands for its folder.
struct FolderModel {
  ObjectInput input;
  /// Of several models of one object, that of the lowest rank is taken.
  std::size_t rank = 0;
};

FolderModel modelOf(const fs::path& file) {
  const fs::path folder = fs::absolute(file).lexically_normal().parent_path();
  const std::size_t rank = makeRank(folder.filename().string());
  const bool is_made = rank < kMakeFolders.size();
  const std::string name = (is_made ? folder.parent_path() : folder).filename().string();
  // The uppermost folder has none.
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

/// Whether a mesh beside the one that stands for the folder is that one in another form.
bool isOtherForm(const fs::path& path) {
  const std::string stem = path.stem().string();
  const auto begins = [&](std::string_view form) { return stem.starts_with(form); };
  return standsForFolder(path) || std::ranges::any_of(kOtherForms, begins);
}

/// The mesh files of the folders at and below one of them.
class MeshSearch {
 public:
  explicit MeshSearch(const fs::path& root) : root_(canonicalPath(root)) {}

  /// Searches a folder. Links to folders wait: whoever searches them last knows which folders have
  /// been found without them.
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

  /// Then the folders behind links, but those that hold the root: they would lead around it.
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

  /// In each folder in the order of formats and names.
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
  /// Canonical: each folder is searched once, by whatever names it can be reached.
  std::set<fs::path> seen_;
  std::vector<fs::path> links_;
  std::map<fs::path, std::vector<fs::path>> folders_;
};

/// The mesh files of each folder at and below `root`, in the order of formats and names.
Result<std::map<fs::path, std::vector<fs::path>>> meshesByFolder(const fs::path& root) {
  MeshSearch meshes(root);
  RETURN_IF_ERROR(meshes.search(root));
  RETURN_IF_ERROR(meshes.followLinks());
  return meshes.take();
}

constexpr std::string_view kVisual = "_visual";
constexpr std::string_view kCollision = "_collision";

/// NAME, where `stem` is NAME and `end`, and both NAME_visual and NAME_collision are among `stems`
/// but not NAME itself: so Gazebo lays out its models.
std::optional<std::string> nameOfPair(const std::string& stem, std::string_view end,
                                      const std::set<std::string>& stems) {
  if (!stem.ends_with(end) || stem.size() == end.size()) return std::nullopt;
  std::string name = stem.substr(0, stem.size() - end.size());
  const bool is_pair = stems.contains(name + std::string(kVisual)) &&
                       stems.contains(name + std::string(kCollision)) && !stems.contains(name);
  return is_pair ? std::optional(std::move(name)) : std::nullopt;
}

/// The objects of a folder in which no file stands for all of it, by their stems. Of a pair of
/// visual and collision mesh the visual one is the object: it is the closer one.
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

/// What a warning says of the meshes that the model of their folder, below `root`, hides.
std::string leftOut(const fs::path& root, const fs::path& model,
                    const std::vector<fs::path>& hidden) {
  constexpr std::size_t kMostNamed = 6;
  // Relative paths, because warnings go into packs, which must not depend on the machine.
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
  // By the folder that the object is named after: one model of each object.
  std::map<fs::path, FolderModel> models;
  for (const auto& [folder, files] : folders) {
    const auto whole = std::find_if(files.begin(), files.end(), standsForFolder);
    if (whole == files.end()) {
      addStems(files, found.objects);
      continue;
    }
    std::vector<fs::path> others;
    std::ranges::remove_copy_if(files, std::back_inserter(others), isOtherForm);
    // Who names a folder of objects means all of them.
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
      // However many inputs there are: the name that it has in a folder that is searched.
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
