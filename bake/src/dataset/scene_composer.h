#pragma once
#include <map>
#include <memory>
#include <set>
#include <string>

#include "dataset/asset_merger.h"
#include "dataset/config/dataset_index.h"
#include "dataset/config/receptacles.h"
#include "dataset/mesh_library.h"
#include "dataset/scene_dataset.h"
#include "dataset/scene_layout.h"

namespace galactic::bake {

/// Puts one scene together; for one use.
class SceneComposer {
 public:
  SceneComposer(const DatasetIndex& index, MeshLibrary& meshes);

  /// What `layout` places. Files that were read for it already are in `read`.
  [[nodiscard]] Result<ComposedScene> run(const std::string& name, const SceneLayout& layout,
                                          const std::vector<std::filesystem::path>& read);

 private:
  /// Notes what is known of it before its mesh or URDF is read.
  [[nodiscard]] Result<void> noteItem(const PlacedItem& placed);
  /// Places what is there.
  [[nodiscard]] Result<void> place(const PlacedItem& placed);
  [[nodiscard]] Result<void> placeStage(const PlacedItem& placed);
  [[nodiscard]] Result<void> placeObject(const PlacedItem& placed);
  [[nodiscard]] Result<void> placeArticulated(const PlacedItem& placed);
  void placeLinks(const ReceptacleParent& placed, const SourceRobot& furniture,
                  const std::filesystem::path& urdf);
  /// Those that a template states, and over them those of its instance.
  void addReceptacles(ReceptacleTexts stated, const ReceptacleTexts& over,
                      const ReceptacleParent& parent);
  /// Loads a mesh and notes its files and warnings.
  [[nodiscard]] Result<std::shared_ptr<const SourceAsset>> load(const std::filesystem::path& mesh);
  /// World frame from the asset's.
  [[nodiscard]] Affine placement(const SceneItem& item, const TemplateAttributes& attributes,
                                 const SourceAsset& asset) const;
  /// Of what is placed too far away for any grid; the grids know no names.
  [[nodiscard]] Result<void> checkDistance(const SceneItem& item, const std::string& what) const;
  void addMesh(const std::filesystem::path& mesh, const SourceAsset& asset,
               const Affine& world_from_asset, const std::string& name);
  /// "chair_:0001" for the second chair.
  std::string nextName(const std::string& template_name);
  void noteMissing(const std::string& sentence);
  void noteAbsent(const std::filesystem::path& file);
  void noteRead(const std::filesystem::path& folder, const ReadFiles& read);
  /// What `file` names and lacks, one sentence each, without which the scene is composed as well.
  void noteLooks(const std::filesystem::path& file, const std::vector<std::string>& missing);
  void warnOnce(const std::string& warning);
  /// The first few warnings about a file.
  void noteWarnings(const std::filesystem::path& file, const std::vector<std::string>& warnings);
  [[nodiscard]] std::string relative(const std::filesystem::path& file) const;

  const DatasetIndex& index_;
  MeshLibrary& meshes_;
  TranslationOrigin default_origin_ = TranslationOrigin::kCenterOfMass;
  ComposedScene result_;
  AssetMerger merger_;
  std::map<std::string, unsigned> placed_;
  /// Sentence to number of times; their order is that of result_.missing.
  std::map<std::string, unsigned> missing_;
  std::set<std::string> absent_;
  std::set<std::string> looks_;
  std::set<std::string> warned_;
};

}  // namespace galactic::bake
