#pragma once
#include <string>
#include <vector>

#include "galactic/bake/scene_dataset.h"
#include "galactic/error.h"
#include "options.h"
#include "plan/pack_list.h"

namespace galactic::bake {

/// The names of the dataset's scenes that `options` want. Fails with kInvalidInput where a pattern
/// fits none.
[[nodiscard]] Result<std::vector<std::string>> wantedScenes(const SceneDataset& dataset,
                                                            const DatasetOptions& options);

/// Adds a pack for each wanted scene of the command's dataset, and one for each movable object in
/// them.
[[nodiscard]] Result<void> addDataset(const BakeCommand& command, PackList& packs);

}  // namespace galactic::bake
