#pragma once
#include <array>

#include "galactic/bake/mesh_import.h"
#include "galactic/pose.h"

namespace galactic::bake {

/// A rotation as w, x, y, z in double precision, as episode sets write them.
using Rotation = std::array<double, 4>;

/// The rotation that turns points of an object's pack (Y up) into points of its mesh file, whose up
/// axis is `up`: the opposite of what the importer of meshes does.
[[nodiscard]] Rotation fileFromPack(UpAxis up);

/// First `b`, then `a`.
[[nodiscard]] Rotation product(const Rotation& a, const Rotation& b);

/// The length of the four numbers.
[[nodiscard]] double lengthOf(const Rotation& rotation);

/// Made a unit quaternion. One that is of unit length to within the rounding of floats stays as it
/// is: what was exported from a pack comes back as the same floats.
[[nodiscard]] Rotation ofUnitLength(const Rotation& rotation);

/// As floats. What the rounding of a turn to another frame and back leaves in parts that are nearly
/// 0, the writer of packs takes away.
[[nodiscard]] Quat narrow(const Rotation& rotation);

/// The same as a pose at `point`, meters.
[[nodiscard]] Pose narrow(const std::array<double, 3>& point, const Rotation& rotation);

}  // namespace galactic::bake
