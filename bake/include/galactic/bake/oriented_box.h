#pragma once
#include <span>

#include "galactic/pose.h"
#include "galactic/vec3.h"

namespace galactic::bake {

/// How the axes of an oriented box are chosen.
enum class BoxFit {
  kYaw,      ///< Vertical axis kept, least area in the ground plane; kMinimum where it saves much.
  kMinimum,  ///< Least volume over all rotations.
  kAxisAligned,  ///< The axes of the object's frame.
};

/// A box in the frame of its object.
struct OrientedBox {
  /// Centre and rotation: object_from_box.
  Pose pose;
  /// Metres, each >= kMinHalfExtent.
  Vec3 half_extents;
};

/// kYaw gives the box of least volume instead when that is smaller by more than this share.
inline constexpr double kMinimumBoxSaving = 0.05;
/// Flat and thin input is given this half extent, so that no box is without volume. Metres.
inline constexpr float kMinHalfExtent = 5e-5F;

/// What was fitted, and what the simpler ways would have given.
struct BoxFitResult {
  OrientedBox box;
  /// The way that was used in the end: kYaw becomes kMinimum where that saves enough.
  BoxFit used = BoxFit::kYaw;
  /// Cubic metres.
  double volume = 0;
  double axis_aligned_volume = 0;
  double pca_volume = 0;
};

/// The oriented box of `points` (object frame, Y up, metres, finite, at least one). Every point
/// lies inside it: the extents are taken from the points themselves. Deterministic.
[[nodiscard]] BoxFitResult fitOrientedBox(std::span<const Vec3> points, BoxFit fit);

}  // namespace galactic::bake
