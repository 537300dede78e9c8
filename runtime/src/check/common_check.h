#pragma once
#include <cmath>
#include <string>

#include "galactic/error.h"
#include "galactic/schema/pack_generated.h"

namespace galactic::detail {

// Checks that several kinds of packs share.

[[nodiscard]] inline bool isEmpty(const flatbuffers::String* text) { return text->size() == 0; }

[[nodiscard]] inline bool isFinite(const schema::Vec3& v) {
  return std::isfinite(v.x()) && std::isfinite(v.y()) && std::isfinite(v.z());
}

/// How far coordinates and lengths of packs may reach, meters, as docs/packs.md says: beyond that,
/// floats are coarser than 0.1 mm, and far beyond it, their squares are infinite.
inline constexpr float kFarthest = 800;
/// Limit for angles, however often something has turned, and for joint positions: what follows from
/// them along the longest chain of links is still finite when squared.
inline constexpr float kMostAngle = 1e9F;

/// A coordinate, meters.
[[nodiscard]] inline bool isCoordinate(float meters) { return std::fabs(meters) <= kFarthest; }

/// How far from the origin a plane through points with such coordinates may be, meters: as far as
/// the corners of their cube.
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
  // Smaller lengths have no finite inverse.
  constexpr float kSmallestLength = 1e-9F;
  return meters >= kSmallestLength && meters <= kFarthest;
}

/// An angle, radians, or a position of a joint.
[[nodiscard]] inline bool isAngle(float radians) { return std::fabs(radians) <= kMostAngle; }

/// A finite amount of 0 or more.
[[nodiscard]] inline bool isAmount(double value) { return std::isfinite(value) && value >= 0; }

/// Much more than rounding to floats can change a squared length of 1.
inline constexpr double kUnitTolerance = 1e-3;
/// The same for the links of a robot, whose rotations are multiplied along a chain: even a chain of
/// 65,535 links would not double them.
inline constexpr double kChainTolerance = 1e-5;

/// Whether the length is 1 up to the rounding of floats. Inline, like the next function: large
/// packs call them millions of times.
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

/// Checks that bounds are within kFarthest, and no minimum exceeds its maximum.
[[nodiscard]] Result<void> checkBounds(const schema::Bounds* bounds, const std::string& where);

/// Checks that the counts add up.
[[nodiscard]] Result<void> checkImport(const schema::ImportStatistics& counts,
                                       const std::string& where);

/// Checks that there are 1 to 8 ascending lengths.
[[nodiscard]] Result<void> checkRadii(const flatbuffers::Vector<float>& radii,
                                      const std::string& where);

/// Checks that centers are places, that radii belong to the working set, and that spheres are in
/// the order of the schema from `begin` to `end`.
struct SphereRange {
  std::size_t begin = 0;
  std::size_t end = 0;
};
[[nodiscard]] Result<void> checkSpheres(
    const flatbuffers::Vector<const schema::SetSphere*>& spheres, const SphereRange& range,
    std::size_t radii, const std::string& where);

/// Checks that amounts are finite, and ordered where the schema orders them.
[[nodiscard]] Result<void> checkSphereStatistics(const schema::SphereSetStatistics& statistics,
                                                 const std::string& where);

/// Checks that positions are places, triangles are whole and have existing corners, and that there
/// is a color for each vertex or none at all.
[[nodiscard]] Result<void> checkSurface(const schema::Surface& surface, const std::string& where);

}  // namespace galactic::detail
