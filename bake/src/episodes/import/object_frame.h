#pragma once
#include <array>

#include "galactic/bake/mesh_import.h"
#include "galactic/pose.h"

namespace galactic::bake {

/// A rotation as w, x, y, z in double precision, the format of episode sets.
using Rotation = std::array<double, 4>;

/// The rotation that takes points of an object's pack (Y up) to points of its mesh file, whose up
/// axis is `up`: the inverse of what the mesh importer does.
[[nodiscard]] Rotation fileFromPack(UpAxis up);

/// The rotation by `b`, followed by that by `a`.
[[nodiscard]] Rotation product(const Rotation& a, const Rotation& b);

/// The length of the four numbers.
[[nodiscard]] double lengthOf(const Rotation& rotation);

/// The rotation as a unit quaternion. Stays as it is if its length is 1 to within float rounding,
/// so that an export from a pack comes back with the same floats.
[[nodiscard]] Rotation ofUnitLength(const Rotation& rotation);

/// The rotation in floats. Rounding may leave tiny parts that ought to be 0 after a change of frame
/// and back; the writer of packs removes them.
[[nodiscard]] Quat narrow(const Rotation& rotation);

/// The rotation in floats, as a pose at `point` (meters).
[[nodiscard]] Pose narrow(const std::array<double, 3>& point, const Rotation& rotation);

}  // namespace galactic::bake
