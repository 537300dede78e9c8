#pragma once
#include <string>
#include <vector>

#include "galactic/bake/scene_files.h"
#include "galactic/error.h"
#include "options.h"
#include "plan/pack_list.h"

namespace galactic::bake {

/// Ascending.
[[nodiscard]] std::vector<std::string> namesOf(const std::vector<SceneFile>& files);

/// The names among `names` that `options` want. Fails with kInvalidInput where a pattern fits none.
[[nodiscard]] Result<std::vector<std::string>> wantedScenes(const std::vector<std::string>& names,
                                                            const DatasetOptions& options);

/// Adds a pack for each wanted scene of the command's dataset, and one for each movable object in
/// them. The command's only input is a dataset's configuration, or a folder of scans.
[[nodiscard]] Result<void> addDataset(const BakeCommand& command, PackList& packs);

}  // namespace galactic::bake
