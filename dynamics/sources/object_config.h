#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "galactic/error.h"

namespace galactic::dynamics {

/// The physical properties in a Habitat object configuration (`NAME.object_config.json`).
struct ObjectConfig {
  std::filesystem::path file;
  /// Kilograms, within kMasses.
  std::optional<double> mass;
  /// Friction of the surface, within kFrictions.
  std::optional<double> friction;
  /// A mesh whose parts are convex pieces; empty if none is given.
  std::filesystem::path collision_asset;
  /// Whether to use the hull of the whole collision asset instead of one hull per mesh.
  bool joins_meshes = false;
  /// One sentence for each value that is not used.
  std::vector<std::string> warnings;
};

/// The configuration file of the object `name` with the mesh `mesh`. Looks in the mesh's folder and
/// the three above it, and in `configs` and `configs/objects` below each of these, as in ReplicaCAD
/// and Habitat's YCB objects. None if there is no such file.
[[nodiscard]] std::optional<std::filesystem::path> findObjectConfig(
    const std::filesystem::path& mesh, std::string_view name);

/// Reads a configuration. Values outside the ranges in body_ranges.h become warnings. Fails with
/// kIo, and with kInvalidInput if the file is not a JSON object, is larger than 1 MiB, or is nested
/// too deeply for the bake's JSON reader.
[[nodiscard]] Result<ObjectConfig> readObjectConfig(const std::filesystem::path& file);

}  // namespace galactic::dynamics
