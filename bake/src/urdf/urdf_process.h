#pragma once
#include <chrono>
#include <filesystem>
#include <vector>

#include "galactic/error.h"
#include "urdf/urdf_model.h"

namespace galactic::bake {

/// Reads a URDF file in a process of its own, so that no XML can crash or hang this one. Fails with
/// kIo, kUnsupported (xacro) or kInvalidInput (empty, beyond kMaxUrdfBytes, refused by the parser,
/// too deep, too slow).
[[nodiscard]] Result<UrdfModel> readUrdf(const std::filesystem::path& path,
                                         std::chrono::seconds time_limit);

/// The same for the <link_sphere_approximation> elements of an SRDF file, in the URDF's frame.
[[nodiscard]] Result<std::vector<LinkSpheres>> readSrdf(const std::filesystem::path& path,
                                                        std::chrono::seconds time_limit);

}  // namespace galactic::bake
