#pragma once
#include <string>
#include <vector>

#include "galactic/error.h"
#include "robot_description/description.h"

namespace galactic::bake {

/// Parses URDF text. Use it in a process of its own: deep or endless XML may crash or hang the
/// parser, and its messages go through a global variable of its library. Errors begin with `where`.
[[nodiscard]] Result<RobotDescription> parseUrdf(const std::string& text, const std::string& where,
                                                 DescriptionPart part);

/// Parses the <link_sphere_approximation> elements of SRDF text; the spheres stay in the URDF's
/// frame. Use it in a process of its own, as with parseUrdf.
[[nodiscard]] Result<std::vector<LinkSpheres>> parseSrdf(const std::string& text,
                                                         const std::string& where);

}  // namespace galactic::bake
