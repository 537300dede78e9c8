#pragma once
#include <filesystem>
#include <optional>
#include <vector>

#include "galactic/pack.h"
#include "galactic/scene.h"

namespace galactic::pack_tool {

/// An open scene pack and the scene in it.
struct OpenScene {
  PackFile pack;
  Scene scene;

  /// Opens `path`. Fails as PackFile::open and Scene::from do.
  [[nodiscard]] static Result<OpenScene> open(const std::filesystem::path& path, Trust trust);

  /// The grid of `radius`, or all of them. Fails with kInvalidInput, naming the radii there are,
  /// when there is none of this radius.
  [[nodiscard]] Result<std::vector<ColumnGrid>> grids(std::optional<float> radius) const;
};

}  // namespace galactic::pack_tool
