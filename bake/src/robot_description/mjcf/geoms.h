#pragma once
#include <optional>
#include <vector>

#include "robot_description/description.h"
#include "robot_description/mjcf/assets.h"
#include "robot_description/mjcf/attributes.h"

namespace galactic::bake {

/// A shape of a body, and its purpose.
struct MjcfGeom {
  /// Its parts in the body's frame: one, or the three of a capsule.
  std::vector<DescribedShape> shapes;
  /// False if contype and conaffinity are both 0: the shape is then only for looks.
  bool collides = true;
  /// By default, MuJoCo's viewer shows groups 0 to 2.
  bool is_shown = true;
  /// Whether it is fully transparent.
  bool is_invisible = false;
  /// Its mass: one of these, or none. In the body's frame, and not yet assigned to a link.
  std::optional<LinkInertial> inertial;
  std::optional<DescribedMass> mass;
};

/// Reads a <geom>. `body_from_frame` is the frame that it is in, including all <frame> elements
/// around it. None, with a warning, for planes and height fields, which are not parts of robots.
[[nodiscard]] std::optional<MjcfGeom> readGeom(const MjcfAttributes& geom,
                                               const Affine& body_from_frame,
                                               const MjcfAssets& assets,
                                               const MjcfSettings& settings);

/// Converts the moments `principal` (about the center, along the axes of `turned`) to the frame
/// that `turned` is in: xx, yy, zz, xy, xz, yz.
[[nodiscard]] std::array<double, 6> momentsAlong(const Affine& turned,
                                                 const std::array<double, 6>& principal);

}  // namespace galactic::bake
