#pragma once
#include <chrono>
#include <filesystem>
#include <vector>

#include "galactic/error.h"
#include "robot_description/description_reader.h"

namespace galactic::bake {

/// Reads a robot's file, and what it includes, in a process of its own, so that no XML can crash or
/// hang this one. Fails with kIo, kUnsupported (xacro, elements of MJCF that make others) or
/// kInvalidInput (empty, beyond kMaxRobotFileBytes, refused by the parser, too deep, too slow).
[[nodiscard]] Result<RobotDescription> readDescription(const std::filesystem::path& path,
                                                       const DescriptionRequest& request,
                                                       std::chrono::seconds time_limit);

/// The same for the <link_sphere_approximation> elements of an SRDF file, Z up as it is.
[[nodiscard]] Result<std::vector<LinkSpheres>> readSrdf(const std::filesystem::path& path,
                                                        std::chrono::seconds time_limit);

}  // namespace galactic::bake
