#pragma once
#include <cstdint>
#include <filesystem>
#include <set>

#include "galactic/bake/robot_import.h"

namespace galactic::bake {

/// The files that a glTF (buffers and images) or a robot's file (.urdf, .xml or .mjcf: meshes, and
/// what these name, textures and what is included) names and that are there; none for other files.
/// For expectations of how much will be read, so quick: a robot's file is searched for names
/// without a parser, and what cannot be understood names nothing.
[[nodiscard]] std::set<std::filesystem::path> namedFiles(const std::filesystem::path& input,
                                                         const RobotImportOptions& options);

/// Bytes of `input` and of its namedFiles(); 0 where it is not there.
[[nodiscard]] std::uint64_t bytesWithNamedFiles(const std::filesystem::path& input,
                                                const RobotImportOptions& options);

}  // namespace galactic::bake
