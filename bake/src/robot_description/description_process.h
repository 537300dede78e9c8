#pragma once
#include <chrono>
#include <filesystem>
#include <vector>

#include "galactic/error.h"
#include "robot_description/description_reader.h"

namespace galactic::bake {

/// Reads a robot's file, and the files it includes, in a process of its own, so that no XML can
/// crash or hang this one. Fails with kIo, with kUnsupported (xacro, or MJCF elements that generate
/// others), or with kInvalidInput (the file is empty, exceeds kMaxRobotFileBytes, is refused by the
/// parser, is nested too deep, or takes too long).
[[nodiscard]] Result<RobotDescription> readDescription(const std::filesystem::path& path,
                                                       const DescriptionRequest& request,
                                                       std::chrono::seconds time_limit);

/// The same for the <link_sphere_approximation> elements of an SRDF file; the spheres stay Z up.
[[nodiscard]] Result<std::vector<LinkSpheres>> readSrdf(const std::filesystem::path& path,
                                                        std::chrono::seconds time_limit);

}  // namespace galactic::bake
