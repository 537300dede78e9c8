#pragma once
#include <span>

#include "fit/box_axes.h"
#include "fit/vec3d.h"
#include "galactic/pose.h"

namespace galactic::bake::fit {

/// The axes of a box of (nearly) least volume around `points` (meters, finite, at least one): over
/// ten scanned objects at most 0.05 % above the best of 200 random starts walked downhill. Sides
/// shorter than `min_side` count as that long. Flat points get the smallest rectangle, collinear
/// ones their line. Candidates are the points' own axes, DiTO-14 and the exact best box around each
/// face normal of the hull (an optimum has a face flush with the hull or two edges; O'Rourke 1985);
/// the best of them are improved by calipers about their own axes and by Nelder and Mead's simplex
/// over rotations. Deterministic: the effort is counted in steps.
[[nodiscard]] Axes minimumBoxAxes(std::span<const Vec3> points, double min_side);

}  // namespace galactic::bake::fit
