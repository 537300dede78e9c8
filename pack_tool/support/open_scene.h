#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "galactic/pack.h"
#include "galactic/scene.h"

namespace galactic::pack_tool {

/// An open scene pack and the scene in it.
struct OpenScene {
  PackFile pack;
  Scene scene;

  /// Opens `path`. Fails as PackFile::open and sceneOf do.
  [[nodiscard]] static Result<OpenScene> open(const std::filesystem::path& path, Trust trust);
};

/// The scene in `pack`. Fails with kInvalidInput on another kind of pack, saying that it holds no
/// column grids.
[[nodiscard]] Result<Scene> sceneOf(const PackFile& pack);

/// The grid of `radius`, or all of them. Fails with kInvalidInput, naming the radii there are, when
/// there is none of this radius. `where` names the pack.
[[nodiscard]] Result<std::vector<ColumnGrid>> gridsOf(const Scene& scene, const std::string& where,
                                                      std::optional<float> radius);

}  // namespace galactic::pack_tool
