#pragma once
#include <cmath>
#include <string>

#include "galactic/error.h"
#include "galactic/schema/pack_generated.h"

namespace galactic::detail {

// Checks of what several kinds of packs share.

[[nodiscard]] inline bool isEmpty(const flatbuffers::String* text) { return text->size() == 0; }

[[nodiscard]] inline bool isFinite(const schema::Vec3& v) {
  return std::isfinite(v.x()) && std::isfinite(v.y()) && std::isfinite(v.z());
}

/// Coordinates and lengths of packs reach this far, meters, as docs/packs.md says: beyond, floats
/// are coarser than 0.1 mm, and far beyond, their squares are infinite.
inline constexpr float kFarthest = 800;
/// Angles, however often something has turned, and positions of joints: what becomes of them along
/// the longest chain of links, squared, is still finite.
inline constexpr float kMostAngle = 1e9F;

/// A coordinate, meters.
[[nodiscard]] inline bool isCoordinate(float meters) { return std::fabs(meters) <= kFarthest; }

/// How far from the origin a plane may be that passes points of these coordinates, meters: as far
/// as the corners of their cube.
inline constexpr float kFarthestPlane = 1386;
[[nodiscard]] inline bool isPlaneOffset(float meters) {
  return std::fabs(meters) <= kFarthestPlane;
}

/// A point, meters.
[[nodiscard]] inline bool isPlace(const schema::Vec3& v) {
  return isCoordinate(v.x()) && isCoordinate(v.y()) && isCoordinate(v.z());
}

/// A length above 0, meters.
[[nodiscard]] inline bool isLength(float meters) {
  // Its inverse is no infinity.
  constexpr float kSmallestLength = 1e-9F;
  return meters >= kSmallestLength && meters <= kFarthest;
}

/// An angle, radians, or a position of a joint.
[[nodiscard]] inline bool isAngle(float radians) { return std::fabs(radians) <= kMostAngle; }

/// A finite amount of 0 or more.
[[nodiscard]] inline bool isAmount(double value) { return std::isfinite(value) && value >= 0; }

/// What rounding to floats can do to a squared length of 1, and much more.
inline constexpr double kUnitTolerance = 1e-3;
/// The same for the links of a robot, whose rotations are multiplied along a chain: of 65,535 links
/// it would not double.
inline constexpr double kChainTolerance = 1e-5;

/// Length 1 within the rounding of floats. Inline, like the next: large packs ask for millions.
[[nodiscard]] inline bool isUnit(const schema::Vec3& v, double tolerance = kUnitTolerance) {
  const double x = static_cast<double>(v.x());
  const double y = static_cast<double>(v.y());
  const double z = static_cast<double>(v.z());
  return std::fabs(x * x + y * y + z * z - 1) <= tolerance;
}
[[nodiscard]] inline bool isUnit(const schema::Quat& q, double tolerance = kUnitTolerance) {
  const double x = static_cast<double>(q.x());
  const double y = static_cast<double>(q.y());
  const double z = static_cast<double>(q.z());
  const double w = static_cast<double>(q.w());
  return std::fabs(x * x + y * y + z * z + w * w - 1) <= tolerance;
}

/// A place and a unit rotation.
[[nodiscard]] inline bool isRigid(const schema::Pose& pose, double tolerance = kUnitTolerance) {
  return isPlace(pose.translation()) && isUnit(pose.rotation(), tolerance);
}

/// Within kFarthest, and no minimum above its maximum.
[[nodiscard]] Result<void> checkBounds(const schema::Bounds* bounds, const std::string& where);

/// Counts that add up.
[[nodiscard]] Result<void> checkImport(const schema::ImportStatistics& counts,
                                       const std::string& where);

/// 1 to 8 ascending lengths.
[[nodiscard]] Result<void> checkRadii(const flatbuffers::Vector<float>& radii,
                                      const std::string& where);

/// Centers that are places, radii of the working set, in the order of the schema from `begin` to
/// `end`.
struct SphereRange {
  std::size_t begin = 0;
  std::size_t end = 0;
};
[[nodiscard]] Result<void> checkSpheres(
    const flatbuffers::Vector<const schema::SetSphere*>& spheres, const SphereRange& range,
    std::size_t radii, const std::string& where);

/// Finite amounts, ordered where the schema orders them.
[[nodiscard]] Result<void> checkSphereStatistics(const schema::SphereSetStatistics& statistics,
                                                 const std::string& where);

/// Positions that are places, whole triangles of existing corners, a color for each vertex or
/// none.
[[nodiscard]] Result<void> checkSurface(const schema::Surface& surface, const std::string& where);

}  // namespace galactic::detail
