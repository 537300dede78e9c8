#pragma once
#include <span>

#include "galactic/pose.h"
#include "galactic/shapes.h"

namespace galactic::bake {

/// How the axes of an oriented box are chosen.
enum class BoxFit {
  kYaw,      ///< Vertical axis kept, least area in the ground plane; or kMinimum if that is much
             //< smaller.
  kMinimum,  ///< Least volume over all rotations.
  kAxisAligned,  ///< The axes of the object's frame.
};

/// kYaw gives the box of least volume instead when that is smaller by more than this share.
inline constexpr double kMinimumBoxSaving = 0.05;
/// Flat and thin input gets this half extent, so that no box has zero volume. Meters.
inline constexpr float kMinHalfExtent = 5e-5F;

/// The box that was fitted, and the volumes that simpler methods would have given.
struct BoxFitResult {
  OrientedBox box;
  /// The method that was used in the end: kYaw becomes kMinimum if that saves enough.
  BoxFit used = BoxFit::kYaw;
  /// Cubic meters.
  double volume = 0;
  double axis_aligned_volume = 0;
  double pca_volume = 0;
};

/// The oriented box of `points` (object frame, Y up, meters, finite, at least one). Every point
/// lies inside it, even in float arithmetic and with the rounded pose: the extents are taken from
/// the points themselves and enlarged by a micrometer and 5e-7 of the greatest coordinate. Of the
/// 24 rotations that describe the same box, the one nearest to the identity is returned. The box is
/// never larger than the axis-aligned box. With kMinimum, it is not larger than the box of the
/// principal axes either; with kYaw, it is larger by at most kMinimumBoxSaving of its own volume.
/// Flat points get the smallest rectangle, collinear points their line, and a single point an
/// axis-aligned cube, each kMinHalfExtent thick. Deterministic: a function of the set of points,
/// whatever their order. kYaw: rotating calipers in the ground plane (Toussaint 1983), exact.
/// kMinimum: calipers around the normals of the convex hull, and local search. Its volume is a few
/// hundredths of a percent above the best known, and it takes 10 to 40 ms for a scanned object of
/// 8,000 vertices. Safe to call from several threads.
[[nodiscard]] BoxFitResult fitOrientedBox(std::span<const Vec3> points, BoxFit fit);

}  // namespace galactic::bake
