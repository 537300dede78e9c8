#include "dataset/scene_files.h"

#include <algorithm>
#include <array>
#include <map>
#include <string_view>
#include <utility>

#include "common/folder_entries.h"
#include "common/lower_case.h"
#include "dataset/config/dataset_paths.h"
#include "dataset/unique_names.h"
#include "galactic/bake/habitat_names.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

namespace fs = std::filesystem;

/// Deeper folders are not searched: published scans are three deep at most.
constexpr std::size_t kDeepest = 6;
/// By falling preference among files of one scene.
constexpr std::array<std::string_view, 4> kEndings{".glb", kBasisSuffix, ".ply", ".obj"};
/// Parts of the names of files that are no surface to stand on.
constexpr std::array<std::string_view, 4> kNoSurface{".semantic.", "_semantic.", ".navmesh",
                                                     "_navmesh."};

struct Candidate {
  fs::path path;
  /// The path without the ending.
  std::string scene;
  std::size_t preference = 0;
};

std::optional<Candidate> candidateOf(const fs::path& path) {
  const std::string name = lowerCase(path.filename().string());
  for (const std::string_view part : kNoSurface) {
    if (name.find(part) != std::string::npos) return std::nullopt;
  }
  // The longest ending first.
  for (const std::size_t ending : {1U, 0U, 2U, 3U}) {
    if (!name.ends_with(kEndings[ending]) || name.size() == kEndings[ending].size()) continue;
    const fs::path scene = path.parent_path() / habitatName(path.filename().string());
    return Candidate{path, scene.string(), ending};
  }
  return std::nullopt;
}

/// Adds the scenes' files in `folder` and below to `found`, the best for each scene.
Result<void> search(const fs::path& folder, std::size_t depth,
                    std::map<std::string, Candidate>& found) {
  ASSIGN_OR_RETURN(const auto entries, entriesOf(folder));
  for (const FolderEntry& entry : entries) {
    if (entry.kind == EntryKind::kFolder) {
      if (entry.is_link || depth == kDeepest) continue;
      RETURN_IF_ERROR(search(entry.path, depth + 1, found));
      continue;
    }
    auto candidate = candidateOf(entry.path);
    if (!candidate) continue;
    if (entry.kind == EntryKind::kLostLink) return lostLink(entry.path);
    if (entry.kind != EntryKind::kFile) continue;
    const auto [known, is_new] = found.try_emplace(candidate->scene, *candidate);
    if (!is_new && candidate->preference < known->second.preference) {
      known->second = std::move(*candidate);
    }
  }
  return {};
}

/// The folders and the name that tell a scene from others: of SCENE/SCENE and SCENE/mesh only
/// SCENE.
std::vector<std::string> partsOf(const fs::path& scene) {
  constexpr std::array<std::string_view, 3> kGeneric{"mesh", "mesh_z_up", "scene"};
  std::vector<std::string> parts;
  for (const fs::path& part : scene) parts.push_back(part.string());
  if (parts.size() < 2) return parts;
  const std::string& last = parts.back();
  const bool generic = std::find(kGeneric.begin(), kGeneric.end(), last) != kGeneric.end();
  if (generic || last == parts[parts.size() - 2]) parts.pop_back();
  return parts;
}

}  // namespace

Result<std::vector<SceneFile>> findSceneFiles(const fs::path& folder) {
  std::map<std::string, Candidate> found;
  RETURN_IF_ERROR(search(folder, 0, found));
  if (found.empty()) {
    return fail(
        ErrorCode::kInvalidInput, folder.string(),
        "there is no scene in it; expected SCENE/SCENE.glb, or *.glb, *.ply or *.obj files");
  }
  std::vector<Candidate> candidates;
  candidates.reserve(found.size());
  for (auto& [scene, candidate] : found) candidates.push_back(std::move(candidate));
  std::sort(candidates.begin(), candidates.end(),
            [](const Candidate& a, const Candidate& b) { return a.path < b.path; });
  std::vector<SceneFile> files;
  std::vector<std::vector<std::string>> parts;
  files.reserve(candidates.size());
  parts.reserve(candidates.size());
  for (const Candidate& candidate : candidates) {
    parts.push_back(partsOf(fs::path(candidate.scene).lexically_relative(folder)));
    SceneFile& file = files.emplace_back();
    file.path = candidate.path;
    if (candidate.preference <= 1) file.up = UpAxis::kZ;
    const fs::path attributes = candidate.scene + std::string(kStageSuffix);
    std::error_code ignored;
    if (fs::is_regular_file(attributes, ignored)) file.attributes = attributes;
  }
  std::vector<std::string> names = uniqueNames(parts);
  for (std::size_t n = 0; n < files.size(); ++n) files[n].name = std::move(names[n]);
  return files;
}

}  // namespace galactic::bake
