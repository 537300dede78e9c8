#include "dataset/scene_dataset.h"

#include <fmt/format.h>

#include <map>
#include <span>
#include <utility>

#include "dataset/config/dataset_index.h"
#include "dataset/config/scene_instance.h"
#include "dataset/config/template_attributes.h"
#include "dataset/scene_composer.h"
#include "dataset/scene_surveyor.h"
#include "galactic/bake/source_asset.h"
#include "support/nearest_name.h"
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

/// A handle without what leads out of a folder: it becomes the path of a pack.
std::string innerPath(std::string_view handle) {
  std::string path;
  for (const fs::path& part : fs::path(handle).relative_path()) {
    if (part.empty() || part == "." || part == "..") continue;
    path += (path.empty() ? "" : "/") + part.string();
  }
  return path;
}

/// Names for the templates of a list: their own, or their handles where several have the same, and
/// a number where those do not tell them apart.
std::map<std::string, const DatasetTemplate*, std::less<>> namesIn(const TemplateList& list,
                                                                   std::string_view suffix) {
  std::map<std::string_view, unsigned> count;
  for (const auto& [handle, entry] : list.all()) ++count[entry.name];
  std::map<std::string, const DatasetTemplate*, std::less<>> names;
  for (const auto& [handle, entry] : list.all()) {
    std::string_view whole = handle;
    if (whole.ends_with(suffix)) whole.remove_suffix(suffix.size());
    const std::string base = count[entry.name] > 1 ? innerPath(whole) : entry.name;
    std::string name = base;
    for (unsigned number = 2; !names.try_emplace(name, &entry).second; ++number) {
      name = fmt::format("{}_{}", base, number);
    }
  }
  return names;
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
  state->by_name = namesIn(state->index.block(state->kind).templates, namesOf(state->kind).suffix);
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
  return SceneSurveyor(state_->index).run(instance);
}

Result<ComposedScene> SceneDataset::compose(std::string_view scene, MeshLibrary& meshes) const {
  const auto entry = state_->find(scene);
  if (!entry) return tl::unexpected(entry.error());
  ASSIGN_OR_RETURN(const auto instance, state_->instanceOf(**entry));
  std::vector<fs::path> read{state_->index.config};
  if (state_->kind == TemplateKind::kScene && !(*entry)->config.empty()) {
    read.push_back((*entry)->config);
  }
  return SceneComposer(state_->index, meshes).run(std::string(scene), instance, read);
}

}  // namespace galactic::bake
