#pragma once
#include <chrono>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "galactic/error.h"
#include "robot_description/description.h"

namespace galactic::bake {

/// Refuses, with kInvalidInput, what the XML parser must not see: no text, or one that is nested so
/// deep that the parser would exhaust the stack. `where` is put in front of errors.
[[nodiscard]] Result<void> checkRobotText(std::string_view text, const std::string& where);

/// Reads a URDF file in a process of its own, so that no XML can crash or hang this one. Fails with
/// kIo, kUnsupported (xacro) or kInvalidInput (empty, beyond kMaxRobotFileBytes, refused by the
/// parser, too deep, too slow).
[[nodiscard]] Result<RobotDescription> readDescription(const std::filesystem::path& path,
                                                       std::chrono::seconds time_limit);

/// The same for the <link_sphere_approximation> elements of an SRDF file, in the URDF's frame.
[[nodiscard]] Result<std::vector<LinkSpheres>> readSrdf(const std::filesystem::path& path,
                                                        std::chrono::seconds time_limit);

}  // namespace galactic::bake
