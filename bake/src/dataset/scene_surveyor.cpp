#include "dataset/scene_surveyor.h"

#include <fmt/format.h>

#include <system_error>
#include <utility>

#include "dataset/placement.h"
#include "import/source_files.h"

namespace galactic::bake {

namespace fs = std::filesystem;

bool SceneSurveyor::hasFile(const fs::path& file) {
  std::error_code problem;
  const std::uintmax_t bytes = fs::file_size(file, problem);
  if (problem) return false;
  if (seen_.insert(file).second) survey_.bytes += bytes;
  return true;
}

void SceneSurveyor::noteMissing(const std::string& sentence) {
  if (missing_.insert(sentence).second) survey_.missing.push_back(sentence);
}

Result<SceneSurveyor::Known> SceneSurveyor::lookUp(TemplateKind kind, const SceneItem& item) {
  const DatasetBlock& block = index_.block(kind);
  Known known;
  known.entry = block.templates.find(item.template_name).found;
  if (known.entry == nullptr) {
    noteMissing(fmt::format("{} '{}' is in none of the dataset's paths", namesOf(kind).noun,
                            item.template_name));
    return known;
  }
  auto attributes = readAttributes(*known.entry, block, kind);
  if (!attributes) return tl::unexpected(attributes.error());
  known.attributes = std::move(*attributes);
  return known;
}

Result<bool> SceneSurveyor::surveyMesh(TemplateKind kind, const SceneItem& item) {
  const auto known = lookUp(kind, item);
  if (!known) return tl::unexpected(known.error());
  if (known->entry == nullptr) return false;
  const TemplateAttributes& attributes = known->attributes;
  const std::string& stated =
      attributes.render_asset.empty() ? attributes.collision_asset : attributes.render_asset;
  const fs::path mesh = stated.empty() ? known->entry->asset : fileOf(*known->entry, stated);
  if (auto near = index_.checkReach(mesh, placeOf(*known->entry)); !near) {
    return tl::unexpected(near.error());
  }
  if (!hasFile(mesh)) {
    noteMissing(fmt::format("{} '{}': its mesh '{}' is missing", namesOf(kind).noun,
                            known->entry->name, nameRelativeTo(index_.config, mesh)));
    return false;
  }
  if (kind == TemplateKind::kObject && item.motion == MotionType::kDynamic) {
    const Affine object_from_mesh = objectFromAsset(attributes, item.scale);
    survey_.movable.push_back({.name = known->entry->name,
                               .mesh = mesh,
                               .object_from_mesh = object_from_mesh,
                               .world_from_mesh = {}});
  }
  return true;
}

Result<void> SceneSurveyor::surveyFurniture(const SceneItem& item) {
  const auto known = lookUp(TemplateKind::kArticulated, item);
  if (!known) return tl::unexpected(known.error());
  if (known->entry == nullptr) return {};
  const fs::path urdf = urdfOf(*known->entry, known->attributes);
  if (auto near = index_.checkReach(urdf, placeOf(*known->entry)); !near) return near;
  if (hasFile(urdf)) return {};
  noteMissing(fmt::format("{} '{}': its URDF '{}' is missing",
                          namesOf(TemplateKind::kArticulated).noun, known->entry->name,
                          nameRelativeTo(index_.config, urdf)));
  return {};
}

Result<SceneSurvey> SceneSurveyor::run(const SceneInstance& instance) {
  survey_.has_stage = false;
  if (instance.stage) {
    const auto found = surveyMesh(TemplateKind::kStage, *instance.stage);
    if (!found) return tl::unexpected(found.error());
    survey_.has_stage = *found;
  }
  for (const SceneItem& item : instance.objects) {
    if (auto found = surveyMesh(TemplateKind::kObject, item); !found) {
      return tl::unexpected(found.error());
    }
  }
  for (const SceneItem& item : instance.articulated) {
    if (auto done = surveyFurniture(item); !done) return tl::unexpected(done.error());
  }
  return std::move(survey_);
}

}  // namespace galactic::bake
