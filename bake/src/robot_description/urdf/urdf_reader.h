#pragma once
#include <string>
#include <vector>

#include "galactic/error.h"
#include "robot_description/description.h"

namespace galactic::bake {

/// Parses URDF text. For a process of its own: deep or endless XML may crash or hang the parser,
/// and its messages go through a global of the parser's library. `where` is put in front of errors.
[[nodiscard]] Result<RobotDescription> parseUrdf(const std::string& text, const std::string& where,
                                                 DescriptionPart part);

/// Parses the <link_sphere_approximation> elements of SRDF text, spheres still in the URDF's frame.
/// For a process of its own, as parseUrdf.
[[nodiscard]] Result<std::vector<LinkSpheres>> parseSrdf(const std::string& text,
                                                         const std::string& where);

}  // namespace galactic::bake
