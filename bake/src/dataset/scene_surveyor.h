#pragma once
#include <filesystem>
#include <set>
#include <string>

#include "dataset/config/dataset_index.h"
#include "dataset/config/scene_instance.h"
#include "dataset/config/template_attributes.h"
#include "dataset/scene_dataset.h"

namespace galactic::bake {

/// Finds out what a scene names without reading a mesh; for one use.
class SceneSurveyor {
 public:
  explicit SceneSurveyor(const DatasetIndex& index) : index_(index) {}

  [[nodiscard]] Result<SceneSurvey> run(const SceneInstance& instance);

 private:
  /// The template and what is stated about it; null where the dataset has none, which is noted.
  struct Known {
    const DatasetTemplate* entry = nullptr;
    TemplateAttributes attributes;
  };
  [[nodiscard]] Result<Known> lookUp(TemplateKind kind, const SceneItem& item);
  [[nodiscard]] Result<bool> surveyMesh(TemplateKind kind, const SceneItem& item);
  [[nodiscard]] Result<void> surveyFurniture(const SceneItem& item);
  /// Whether the file is there; if so, its size and that of the files that it names are added, each
  /// the first time.
  [[nodiscard]] bool hasFile(const std::filesystem::path& file);
  void noteMissing(const std::string& sentence);

  const DatasetIndex& index_;
  SceneSurvey survey_;
  std::set<std::filesystem::path> seen_;
  std::set<std::string> missing_;
};

}  // namespace galactic::bake
