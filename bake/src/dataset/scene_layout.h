#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "dataset/config/dataset_index.h"
#include "dataset/config/scene_instance.h"
#include "dataset/config/template_attributes.h"
#include "galactic/error.h"

namespace galactic::bake {

/// One thing that a scene places: what it is, and which file holds it.
struct PlacedItem {
  TemplateKind kind = TemplateKind::kObject;
  const SceneItem* item = nullptr;
  /// Null where the dataset has none of that name; so are the attributes.
  const DatasetTemplate* entry = nullptr;
  std::shared_ptr<const TemplateAttributes> attributes{};
  /// Its mesh, or its URDF where it is articulated, absolute; empty where something is missing.
  std::filesystem::path file{};
  /// One sentence where the dataset lacks the template or the file.
  std::string missing{};
  /// Files that were looked for and are not there, absolute.
  std::vector<std::filesystem::path> absent{};
  /// What the user should look at.
  std::string warning{};

  /// Whether it is no part of the scene but an object of its own.
  [[nodiscard]] bool moves() const {
    return kind == TemplateKind::kObject && item->motion == MotionType::kDynamic;
  }
};

/// A scene as its configurations state it, before a mesh or URDF is read.
struct SceneLayout {
  const SceneInstance* instance = nullptr;
  /// The stage, unless the scene says that it has none, then the objects, then what is articulated,
  /// in the order of the instance.
  std::vector<PlacedItem> items{};

  /// Whether the stage is there.
  [[nodiscard]] bool hasStage() const { return instance->stage && !items.front().file.empty(); }
};

/// Looks up everything that `instance` places. The result refers to both arguments. Fails with kIo
/// or kInvalidInput on attributes that cannot be read and on files out of reach; what lacks is no
/// failure.
[[nodiscard]] Result<SceneLayout> layOutScene(const DatasetIndex& index,
                                              const SceneInstance& instance);

}  // namespace galactic::bake
