#pragma once
#include <span>

#include "galactic/pose.h"
#include "galactic/shapes.h"

namespace galactic::bake {

/// How the axes of an oriented box are chosen.
enum class BoxFit {
  kYaw,      ///< Vertical axis kept, least area in the ground plane; kMinimum where it saves much.
  kMinimum,  ///< Least volume over all rotations.
  kAxisAligned,  ///< The axes of the object's frame.
};

/// kYaw gives the box of least volume instead when that is smaller by more than this share.
inline constexpr double kMinimumBoxSaving = 0.05;
/// Flat and thin input is given this half extent, so that no box is without volume. Meters.
inline constexpr float kMinHalfExtent = 5e-5F;

/// What was fitted, and what the simpler ways would have given.
struct BoxFitResult {
  OrientedBox box;
  /// The way that was used in the end: kYaw becomes kMinimum where that saves enough.
  BoxFit used = BoxFit::kYaw;
  /// Cubic meters.
  double volume = 0;
  double axis_aligned_volume = 0;
  double pca_volume = 0;
};

/// The oriented box of `points` (object frame, Y up, meters, finite, at least one). Every point
/// lies inside it, also in float arithmetic and with the rounded pose: the extents are taken from
/// the points themselves and grown by a micrometer and 5e-7 of the greatest coordinate. Of the 24
/// rotations that describe a box the nearest to the identity is given. Never larger than the
/// axis-aligned box; kMinimum never larger than the box of the principal axes either, and kYaw not
/// by more than kMinimumBoxSaving of its own volume. Flat points get the smallest rectangle,
/// collinear ones their line, a single point a cube of axes as they are, kMinHalfExtent thick.
/// Deterministic: a function of the set of points, whatever their order.
/// kYaw: rotating calipers in the ground plane (Toussaint 1983), exact. kMinimum: calipers around
/// the normals of the convex hull and local search; a few 0.01 % above the best known, 10 to 40 ms
/// for a scanned object of 8,000 vertices. Safe to call from several threads.
[[nodiscard]] BoxFitResult fitOrientedBox(std::span<const Vec3> points, BoxFit fit);

}  // namespace galactic::bake
