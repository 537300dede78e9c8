#pragma once
#include "fit/axes.h"
#include "galactic/pose.h"

namespace galactic::bake::fit {

/// The axes with the same box as `axes` (any of the 24 ways to name and sign them, and any mirror
/// image) that are nearest to the identity. Of equally near ones always the same.
[[nodiscard]] Axes nearestEquivalent(const Axes& axes);

/// The rotation that turns the identity into `axes` (right-handed), rounded to floats; w >= 0.
[[nodiscard]] Quat quaternionOf(const Axes& axes);

/// The axes of a quaternion, which need not be of exactly unit length.
[[nodiscard]] Axes axesOf(const Quat& rotation);

/// The shortest rotation that turns the unit vector `from` into `to`, rounded to floats; about X or
/// Z where they are opposite.
[[nodiscard]] Quat shortestArc(const Vec3d& from, const Vec3d& to);

}  // namespace galactic::bake::fit
