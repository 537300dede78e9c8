#pragma once
#include <filesystem>
#include <string>

#include "galactic/error.h"
#include "robot_description/description.h"
#include "robot_description/description_reader.h"

namespace galactic::bake {

/// Parses MJCF text, and the files that it includes, into the same form as a URDF. Use it in a
/// process of its own: see parseXml. docs/objects_and_robots.md says what is read and what is not.
[[nodiscard]] Result<RobotDescription> parseMjcf(const std::string& text,
                                                 const std::filesystem::path& path,
                                                 const DescriptionRequest& request);

}  // namespace galactic::bake
