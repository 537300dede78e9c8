#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "galactic/bake/mesh_library.h"
#include "galactic/bake/scene_dataset.h"
#include "galactic/option_text.h"
#include "options.h"

namespace galactic::bake {

/// A scene instance that becomes a pack.
struct InstancedScene {
  std::shared_ptr<const SceneDataset> dataset;
  /// What scenes of the dataset share.
  std::shared_ptr<MeshLibrary> meshes;
  std::string name;
};

/// One pack of a plan.
struct PlannedPack {
  /// Path below the plan's folder, for example "scenes/kitchen.pack".
  std::string name;
  /// What makes it; its output is set, its jobs are not.
  BakeCommand command;
  /// Where the command's input is a dataset.
  std::optional<InstancedScene> scene;
  /// Names of the files that it depends on begin here.
  std::filesystem::path folder;
  /// Size of its main input: the large ones are baked first.
  std::uint64_t source_bytes = 0;
};

/// A scene that is not baked, and why.
struct LeftOut {
  std::string name;
  std::vector<std::string> reasons;
};

/// Everything that is baked for a dataset or a world.
struct WorldPlan {
  std::filesystem::path world;
  /// Where the other packs go: beside the world pack, with its name.
  std::filesystem::path folder;
  /// Scenes, objects and robot, none of which needs another; ascending names.
  std::vector<PlannedPack> assets;
  /// Made in the assets' packs, or imported.
  std::optional<PlannedPack> episodes;
  /// What the world says of its task, as WorldRecipe has it.
  std::vector<OptionText> task;
  std::vector<LeftOut> left_out;
  /// One sentence each.
  std::vector<std::string> warnings;
};

}  // namespace galactic::bake
