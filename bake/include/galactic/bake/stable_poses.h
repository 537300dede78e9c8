#pragma once
#include <cstddef>
#include <vector>

#include "galactic/bake/triangle_mesh.h"
#include "galactic/pose.h"

namespace galactic::bake {

/// A way in which an object rests on a horizontal plane.
struct StablePose {
  /// plane_from_object: turns the object so that its support face lies down (-Y).
  Quat rotation;
  /// Height of the object's origin above the plane, metres.
  float height = 0;
  /// Share of random drops that end in this pose, 0 to 1.
  float likelihood = 0;
};

/// At most this many poses are kept, the likeliest first.
inline constexpr std::size_t kMaxStablePoses = 16;

/// The stable poses of the solid inside the convex hull of `mesh`, likeliest first. Never empty:
/// flat and thin input rests on its largest faces. Deterministic.
[[nodiscard]] std::vector<StablePose> findStablePoses(const TriangleMesh& mesh);

}  // namespace galactic::bake
