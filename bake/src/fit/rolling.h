#pragma once
#include <cstdint>
#include <vector>

#include "fit/axes.h"
#include "fit/convex_hull.h"

namespace galactic::bake::fit {

/// The center of mass of the solid inside `hull` (kSolid), of uniform density.
[[nodiscard]] Vec3d centerOfMass(const ConvexHull& hull);

/// For each face of `hull` (kSolid), the share of random drops that come to rest on it; 0 for faces
/// that the body rolls off. The shares add up to 1.
///
/// The quasi-static estimate of Goldberg, Mirtich, Zhuang, Craig, Carlisle and Canny, "Part pose
/// statistics: estimators and experiments" (IEEE Transactions on Robotics and Automation 15, 1999):
/// a body in a random orientation lands on the face below its center of mass, and thus on each face
/// with the share of its solid angle. If the center's projection lies outside that face, the body
/// rolls over the edge nearest to the projection, onto the face beyond, and so on. Each roll lowers
/// the center, so that every chain ends.
[[nodiscard]] std::vector<double> restingShares(const ConvexHull& hull);

}  // namespace galactic::bake::fit
