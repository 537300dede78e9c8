#pragma once
#include "galactic/bake/sphere_set.h"
#include "galactic/bake/triangle_mesh.h"
#include "galactic/error.h"

namespace galactic::bake::sphere_fit {

/// Fails with kInvalidInput where an option is out of range, naming the option.
[[nodiscard]] Result<void> checkOptions(const SphereSetOptions& options);

/// Fails with kInvalidInput where the mesh has no triangles or vertices that are no numbers, and
/// with kUnsupported where it is too large.
[[nodiscard]] Result<void> checkMesh(const TriangleMesh& mesh);

}  // namespace galactic::bake::sphere_fit
