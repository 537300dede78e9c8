#pragma once
#include <cstdint>
#include <filesystem>
#include <set>

#include "galactic/bake/robot_import.h"

namespace galactic::bake {

/// The existing files that a glTF names (buffers and images), or a robot's file (.urdf, .xml or
/// .mjcf: meshes and the files these name, textures, and included files); none for other files.
/// Meant for quick estimates of how much will be read: searches a robot's file for names without a
/// parser, and ignores anything it cannot understand.
[[nodiscard]] std::set<std::filesystem::path> namedFiles(const std::filesystem::path& input,
                                                         const RobotImportOptions& options);

/// Total size in bytes of `input` and its namedFiles(); `input` counts 0 if it does not exist.
[[nodiscard]] std::uint64_t bytesWithNamedFiles(const std::filesystem::path& input,
                                                const RobotImportOptions& options);

}  // namespace galactic::bake
