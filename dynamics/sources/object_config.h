#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "galactic/error.h"

namespace galactic::dynamics {

/// What a Habitat object configuration (`NAME.object_config.json`) says of a body.
struct ObjectConfig {
  std::filesystem::path file;
  /// Kilograms, one of kMasses.
  std::optional<double> mass;
  /// Of its surface, one of kFrictions.
  std::optional<double> friction;
  /// A mesh whose parts are convex pieces; empty: none is given.
  std::filesystem::path collision_asset;
  /// Whether the hull of the whole collision asset counts, instead of one for each of its meshes.
  bool joins_meshes = false;
  /// What it says that is not taken, one sentence each.
  std::vector<std::string> warnings;
};

/// Where the configuration of the object `name` lies whose mesh is `mesh`: in the mesh's folder or
/// one of the three above it, there or in `configs` or `configs/objects`, as ReplicaCAD and
/// Habitat's YCB objects have it. None where there is none.
[[nodiscard]] std::optional<std::filesystem::path> findObjectConfig(
    const std::filesystem::path& mesh, std::string_view name);

/// Reads one. Values that no body has (body_ranges.h) become warnings. Fails with kIo, and with
/// kInvalidInput where the file is no JSON object, is larger than 1 MiB or, as far as the bake's
/// reader of JSON says so, nested too deeply.
[[nodiscard]] Result<ObjectConfig> readObjectConfig(const std::filesystem::path& file);

}  // namespace galactic::dynamics
