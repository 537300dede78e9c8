#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "galactic/bake/assets.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

namespace fs = std::filesystem;

/// The mesh formats searched for in folders; of one model in several, the first of them is taken.
constexpr std::array<std::string_view, 8> kMeshExtensions{".glb", ".gltf", ".obj", ".dae",
                                                          ".fbx", ".ply",  ".stl", ".off"};
/// Files that stand for their whole folder.
constexpr std::array<std::string_view, 2> kFolderStems{"textured", "model"};

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
  const std::string name = folder.filename().string();
  const std::size_t rank = makeRank(name);
  if (rank == kMakeFolders.size()) return {{file, name}, 0};
  return {{file, folder.parent_path().filename().string()}, rank};
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

/// The mesh files of each folder at and below `root`, in the order of formats and names.
Result<std::map<fs::path, std::vector<fs::path>>> meshesByFolder(const fs::path& root) {
  std::map<fs::path, std::vector<fs::path>> folders;
  std::error_code problem;
  fs::recursive_directory_iterator walk(root, problem);
  for (; !problem && walk != fs::recursive_directory_iterator(); walk.increment(problem)) {
    std::error_code unknown;
    if (walk->is_regular_file(unknown) && isMesh(walk->path())) {
      folders[walk->path().parent_path()].push_back(walk->path());
    }
  }
  if (problem) {
    return fail(ErrorCode::kIo, root.string(), "cannot be searched: " + problem.message());
  }
  for (auto& [folder, files] : folders) {
    std::sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) {
      return std::pair(formatRank(a), a) < std::pair(formatRank(b), b);
    });
  }
  return folders;
}

Result<void> addFolder(const fs::path& root, std::vector<ObjectInput>& objects) {
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
    if (whole != files.end()) {
      FolderModel model = modelOf(*whole);
      const bool is_made = makeRank(folder.filename().string()) < kMakeFolders.size();
      const auto [known, is_new] =
          models.try_emplace(is_made ? folder.parent_path() : folder, model);
      if (!is_new && model.rank < known->second.rank) known->second = std::move(model);
      continue;
    }
    std::set<std::string> stems;
    for (const fs::path& file : files) {
      if (stems.insert(file.stem().string()).second) {
        objects.push_back({file, file.stem().string()});
      }
    }
  }
  for (auto& [folder, model] : models) objects.push_back(std::move(model.input));
  return {};
}

}  // namespace

Result<std::vector<ObjectInput>> findObjects(const std::vector<fs::path>& inputs) {
  std::vector<ObjectInput> objects;
  for (const fs::path& input : inputs) {
    std::error_code unknown;
    if (!fs::is_directory(input, unknown)) {
      const fs::path parent = fs::absolute(input).lexically_normal().parent_path();
      objects.push_back({input, standsForFolder(input) && inputs.size() > 1
                                    ? parent.filename().string()
                                    : input.stem().string()});
      continue;
    }
    RETURN_IF_ERROR(addFolder(input, objects));
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
  return objects;
}

}  // namespace galactic::bake
