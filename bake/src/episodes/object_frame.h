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

/// Rounded once.
[[nodiscard]] Quat narrow(const Rotation& rotation);

}  // namespace galactic::bake
