#pragma once
#include <cstddef>
#include <vector>

#include "galactic/bake/triangle_mesh.h"
#include "galactic/shapes.h"

namespace galactic::bake {

/// At most this many poses are kept, the likeliest first.
inline constexpr std::size_t kMaxStablePoses = 16;

/// Poses whose down directions differ by less than this are one: the likeliest, with the shares of
/// all. Radians.
inline constexpr double kSamePoseAngle = 0.05;

/// The stable poses of the solid of even density inside the convex hull of `mesh` (object frame,
/// meters, finite), likeliest first; of equally likely ones, the more upright first. Heights are
/// such that no vertex is below the plane. Never empty: a flat mesh rests on either side, one that
/// is a line on four of its sides, a point as it is.
/// Likelihoods by the quasi-static estimate of Goldberg et al., "Part pose statistics: estimators
/// and experiments" (1999): the share of directions in which a face lies below the center of mass,
/// its own and those of the faces from which the body rolls onto it. Deterministic.
[[nodiscard]] std::vector<StablePose> findStablePoses(const TriangleMesh& mesh);

}  // namespace galactic::bake
