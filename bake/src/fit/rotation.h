#pragma once
#include "fit/axes.h"
#include "galactic/pose.h"

namespace galactic::bake::fit {

/// The axes nearest to the identity that give the same box as `axes`: any of the 24 ways to name
/// and sign them, and any mirror image. Ties are always resolved the same way.
[[nodiscard]] Axes nearestEquivalent(const Axes& axes);

/// The rotation from the identity to `axes` (right-handed), rounded to floats; w >= 0.
[[nodiscard]] Quat quaternionOf(const Axes& axes);

/// The axes of a quaternion, whose length need not be exactly 1.
[[nodiscard]] Axes axesOf(const Quat& rotation);

/// The shortest rotation from the unit vector `from` to `to`, rounded to floats; about X or Z if
/// they are opposite.
[[nodiscard]] Quat shortestArc(const Vec3d& from, const Vec3d& to);

}  // namespace galactic::bake::fit
