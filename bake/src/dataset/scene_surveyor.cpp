#include "dataset/scene_surveyor.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <utility>

#include "dataset/config/placement.h"
#include "import/source_files.h"
#include "support/try.h"
#include "urdf/named_files.h"

namespace galactic::bake {

namespace fs = std::filesystem;

bool SceneSurveyor::hasFile(const fs::path& file) {
  std::error_code problem;
  const std::uintmax_t bytes = fs::file_size(file, problem);
  if (problem) return false;
  if (!seen_.insert(file).second) return true;
  survey_.bytes += bytes;
  for (const fs::path& named : namedFiles(file, {})) (void)hasFile(named);
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
  ASSIGN_OR_RETURN(auto attributes, readAttributes(*known.entry, block, kind));
  known.attributes = std::move(attributes);
  return known;
}

Result<bool> SceneSurveyor::surveyMesh(TemplateKind kind, const SceneItem& item) {
  ASSIGN_OR_RETURN(const auto known, lookUp(kind, item));
  if (known.entry == nullptr) return false;
  const TemplateAttributes& attributes = known.attributes;
  ASSIGN_OR_RETURN(const auto mesh, meshFileOf(*known.entry, attributes));
  RETURN_IF_ERROR(index_.checkReach(mesh, placeOf(*known.entry)));
  std::error_code ignored;
  if (!fs::is_regular_file(mesh, ignored)) {
    noteMissing(fmt::format("{} '{}': its mesh '{}' is missing", namesOf(kind).noun,
                            known.entry->name, nameRelativeTo(index_.config, mesh)));
    return false;
  }
  if (kind == TemplateKind::kObject && item.motion == MotionType::kDynamic) {
    survey_.movable.push_back({.name = known.entry->name,
                               .mesh = mesh,
                               .object_from_mesh = objectFromAsset(attributes, item.scale)});
    return true;
  }
  if (hasFile(mesh) && std::ranges::find(survey_.meshes, mesh) == survey_.meshes.end()) {
    survey_.meshes.push_back(mesh);
  }
  return true;
}

Result<void> SceneSurveyor::surveyFurniture(const SceneItem& item) {
  ASSIGN_OR_RETURN(const auto known, lookUp(TemplateKind::kArticulated, item));
  if (known.entry == nullptr) return {};
  const fs::path urdf = urdfOf(*known.entry, known.attributes);
  if (auto near = index_.checkReach(urdf, placeOf(*known.entry)); !near) return near;
  if (hasFile(urdf)) return {};
  noteMissing(fmt::format("{} '{}': its URDF '{}' is missing",
                          namesOf(TemplateKind::kArticulated).noun, known.entry->name,
                          nameRelativeTo(index_.config, urdf)));
  return {};
}

Result<SceneSurvey> SceneSurveyor::run(const SceneInstance& instance) {
  survey_.has_stage = false;
  if (instance.stage) {
    ASSIGN_OR_RETURN(const auto found, surveyMesh(TemplateKind::kStage, *instance.stage));
    survey_.has_stage = found;
  }
  for (const SceneItem& item : instance.objects) {
    RETURN_IF_ERROR(surveyMesh(TemplateKind::kObject, item));
  }
  for (const SceneItem& item : instance.articulated) {
    RETURN_IF_ERROR(surveyFurniture(item));
  }
  return std::move(survey_);
}

}  // namespace galactic::bake
