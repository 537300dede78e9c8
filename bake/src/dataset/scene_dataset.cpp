#include "dataset/scene_dataset.h"

#include <fmt/format.h>

#include <map>
#include <set>
#include <span>
#include <system_error>
#include <utility>

#include "dataset/config/dataset_index.h"
#include "dataset/config/placement.h"
#include "dataset/config/scene_instance.h"
#include "dataset/config/template_attributes.h"
#include "dataset/scene_composer.h"
#include "dataset/scene_layout.h"
#include "dataset/unique_names.h"
#include "galactic/bake/habitat_names.h"
#include "galactic/bake/read_files.h"
#include "robot_description/named_files.h"
#include "support/text/nearest_name.h"
#include "support/try.h"

namespace galactic::bake {

namespace fs = std::filesystem;

struct SceneDataset::State {
  DatasetIndex index;
  /// What the scenes are made of: scene instances, or stages where there are none.
  TemplateKind kind = TemplateKind::kScene;
  std::map<std::string, const DatasetTemplate*, std::less<>> by_name;
  std::vector<std::string> names;

  [[nodiscard]] Result<const DatasetTemplate*> find(std::string_view scene) const;
  [[nodiscard]] Result<SceneInstance> instanceOf(const DatasetTemplate& entry) const;
};

namespace {

/// The folders of a template's handle without what leads out of them, and its name.
std::vector<std::string> partsOf(const DatasetTemplate& entry) {
  std::vector<std::string> parts;
  for (const fs::path& part : fs::path(entry.handle).relative_path().parent_path()) {
    if (!part.empty() && part != "." && part != "..") parts.push_back(part.string());
  }
  parts.push_back(entry.name);
  return parts;
}

/// Whether the list has the scan of `entry` with plain textures, too, which can be read.
bool isCopyOfAnother(const DatasetTemplate& entry, const TemplateList& list) {
  std::string_view handle = entry.handle;
  if (!handle.ends_with(kBasisSuffix)) return false;
  handle.remove_suffix(kBasisSuffix.size());
  return list.all().contains(std::string(handle) + ".glb");
}

/// Names for the templates of a list, which become files: packs find their textures beside the
/// folder that they lie in. Each scan once.
std::map<std::string, const DatasetTemplate*, std::less<>> namesIn(const TemplateList& list) {
  std::vector<const DatasetTemplate*> entries;
  std::vector<std::vector<std::string>> paths;
  entries.reserve(list.all().size());
  paths.reserve(list.all().size());
  for (const auto& [handle, entry] : list.all()) {
    if (isCopyOfAnother(entry, list)) continue;
    entries.push_back(&entry);
    paths.push_back(partsOf(entry));
  }
  std::vector<std::string> unique = uniqueNames(paths);
  std::map<std::string, const DatasetTemplate*, std::less<>> names;
  for (std::size_t n = 0; n < entries.size(); ++n) names.emplace(std::move(unique[n]), entries[n]);
  return names;
}

/// Adds the size of `file` and of the files that it names, each the first time.
void addBytes(const fs::path& file, std::set<fs::path>& seen, std::uint64_t& bytes) {
  std::error_code problem;
  const std::uintmax_t more = fs::file_size(file, problem);
  if (problem || !seen.insert(file).second) return;
  bytes += more;
  for (const fs::path& named : namedFiles(file, {})) addBytes(named, seen, bytes);
}

SceneSurvey surveyOf(const SceneLayout& layout) {
  SceneSurvey survey;
  survey.has_stage = layout.hasStage();
  std::set<std::string_view> missing;
  std::set<fs::path> meshes;
  std::set<fs::path> seen;
  for (const PlacedItem& placed : layout.items) {
    if (!placed.missing.empty()) {
      if (missing.insert(placed.missing).second) survey.missing.push_back(placed.missing);
    } else if (placed.moves()) {
      survey.movable.push_back(
          {.name = placed.entry->name,
           .mesh = placed.file,
           .object_from_mesh = objectFromAsset(*placed.attributes, placed.item->scale)});
    } else {
      addBytes(placed.file, seen, survey.bytes);
      const bool is_mesh = placed.kind != TemplateKind::kArticulated;
      if (is_mesh && meshes.insert(placed.file).second) survey.meshes.push_back(placed.file);
    }
  }
  return survey;
}

/// A scene of nothing but the stage.
SceneInstance sceneOfStage(const DatasetTemplate& stage) {
  SceneInstance scene;
  scene.stage.emplace().template_name = stage.handle;
  return scene;
}

}  // namespace

MeshImportOptions datasetMeshOptions() {
  MeshImportOptions options;
  options.up = UpAxis::kY;
  options.smallest_size = 0;
  return options;
}

SceneDataset::SceneDataset(std::unique_ptr<State> state) : state_(std::move(state)) {}
SceneDataset::~SceneDataset() = default;
SceneDataset::SceneDataset(SceneDataset&&) noexcept = default;
SceneDataset& SceneDataset::operator=(SceneDataset&&) noexcept = default;

Result<SceneDataset> SceneDataset::read(const fs::path& config, const DatasetReadOptions& options) {
  ASSIGN_OR_RETURN(auto index, readDatasetIndex(config, options.allow_outside));
  auto state = std::make_unique<State>();
  state->index = std::move(index);
  if (state->index.block(TemplateKind::kScene).templates.all().empty()) {
    state->kind = TemplateKind::kStage;
  }
  state->by_name = namesIn(state->index.block(state->kind).templates);
  state->names.reserve(state->by_name.size());
  for (const auto& [name, entry] : state->by_name) state->names.push_back(name);
  if (state->names.empty()) {
    return fail(ErrorCode::kInvalidInput, config.string(),
                "it has neither scene instances nor stages; are the files that its 'paths' name "
                "there?");
  }
  return SceneDataset(std::move(state));
}

const std::vector<std::string>& SceneDataset::scenes() const { return state_->names; }
const fs::path& SceneDataset::folder() const { return state_->index.folder; }
const std::vector<std::string>& SceneDataset::warnings() const { return state_->index.warnings; }

std::uint64_t SceneDataset::fingerprint() const {
  std::string all;
  for (const DatasetBlock& block : state_->index.blocks) {
    for (const auto& [handle, entry] : block.templates.all()) all += handle + '\n';
    all += '\n';
  }
  return describeBytes({}, std::as_bytes(std::span(all))).hash_low;
}

Result<const DatasetTemplate*> SceneDataset::State::find(std::string_view scene) const {
  const auto found = by_name.find(scene);
  if (found != by_name.end()) return found->second;
  return fail(ErrorCode::kInvalidInput, index.config.string(),
              fmt::format("it has no scene '{}'; {}", scene, suggestNames(scene, names)));
}

Result<SceneInstance> SceneDataset::State::instanceOf(const DatasetTemplate& entry) const {
  if (kind == TemplateKind::kStage) return sceneOfStage(entry);
  ASSIGN_OR_RETURN(const auto layers, layersOf(entry, index.block(kind), kind));
  return readSceneInstance(layers);
}

Result<SceneSurvey> SceneDataset::survey(std::string_view scene) const {
  const auto entry = state_->find(scene);
  if (!entry) return tl::unexpected(entry.error());
  ASSIGN_OR_RETURN(const auto instance, state_->instanceOf(**entry));
  ASSIGN_OR_RETURN(const auto layout, layOutScene(state_->index, instance));
  return surveyOf(layout);
}

Result<ComposedScene> SceneDataset::compose(std::string_view scene, MeshLibrary& meshes) const {
  const auto entry = state_->find(scene);
  if (!entry) return tl::unexpected(entry.error());
  ASSIGN_OR_RETURN(const auto instance, state_->instanceOf(**entry));
  std::vector<fs::path> read{state_->index.config};
  if (state_->kind == TemplateKind::kScene && !(*entry)->config.empty()) {
    read.push_back((*entry)->config);
  }
  ASSIGN_OR_RETURN(const auto layout, layOutScene(state_->index, instance));
  return SceneComposer(state_->index, meshes).run(std::string(scene), layout, read);
}

}  // namespace galactic::bake
