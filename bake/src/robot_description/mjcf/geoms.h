#pragma once
#include <optional>
#include <vector>

#include "robot_description/description.h"
#include "robot_description/mjcf/assets.h"
#include "robot_description/mjcf/attributes.h"

namespace galactic::bake {

/// A shape of a body, and what it is for.
struct MjcfGeom {
  /// What it consists of, in the body's frame: one, or the three parts of a capsule.
  std::vector<DescribedShape> shapes;
  /// Neither contype nor conaffinity is 0: else it is only seen.
  bool collides = true;
  /// MuJoCo's viewer shows groups 0 to 2 unless it is told otherwise.
  bool is_shown = true;
  /// Seen through entirely.
  bool is_invisible = false;
  /// What it weighs: one of these, or nothing. In the body's frame; of no link yet.
  std::optional<LinkInertial> inertial;
  std::optional<DescribedMass> mass;
};

/// A <geom> whose frame, with all <frame> elements around it, is `body_from_frame`; nothing, with a
/// warning, for planes and height fields, which no robot consists of.
[[nodiscard]] std::optional<MjcfGeom> readGeom(const MjcfAttributes& geom,
                                               const Affine& body_from_frame,
                                               const MjcfAssets& assets,
                                               const MjcfSettings& settings);

/// The moments `principal` (about the center, along the axes of `turned`) along the axes of the
/// frame that `turned` is in: xx, yy, zz, xy, xz, yz.
[[nodiscard]] std::array<double, 6> momentsAlong(const Affine& turned,
                                                 const std::array<double, 6>& principal);

}  // namespace galactic::bake
