#pragma once
#include <cstddef>
#include <vector>

#include "galactic/bake/triangle_mesh.h"
#include "galactic/shapes.h"

namespace galactic::bake {

/// At most this many of the likeliest poses are kept.
inline constexpr std::size_t kMaxStablePoses = 16;

/// Poses whose down directions differ by less than this are merged into the likeliest, which gets
/// the sum of their likelihoods. Radians.
inline constexpr double kSamePoseAngle = 0.05;

/// The stable poses of the solid of uniform density inside the convex hull of `mesh` (object frame,
/// meters, finite), likeliest first; of equally likely ones, the more upright first. Heights are
/// such that no vertex is below the plane. Never empty: a flat mesh rests on either side, a line on
/// four sides, a point as it is. Likelihoods follow the quasi-static estimate of Goldberg et al.,
/// "Part pose statistics: estimators and experiments" (1999): the share of directions in which the
/// resting face, or a face from which the body rolls onto it, lies below the center of mass.
/// Deterministic.
[[nodiscard]] std::vector<StablePose> findStablePoses(const TriangleMesh& mesh);

}  // namespace galactic::bake
