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

/// A finite amount of 0 or more.
[[nodiscard]] inline bool isAmount(double value) { return std::isfinite(value) && value >= 0; }

/// What rounding to floats can do to a squared length of 1, and much more.
inline constexpr double kUnitTolerance = 1e-3;

/// Length 1 within the rounding of floats. Inline, like the next: large packs ask for millions.
[[nodiscard]] inline bool isUnit(const schema::Vec3& v) {
  const double x = static_cast<double>(v.x());
  const double y = static_cast<double>(v.y());
  const double z = static_cast<double>(v.z());
  return std::fabs(x * x + y * y + z * z - 1) <= kUnitTolerance;
}
[[nodiscard]] inline bool isUnit(const schema::Quat& q) {
  const double x = static_cast<double>(q.x());
  const double y = static_cast<double>(q.y());
  const double z = static_cast<double>(q.z());
  const double w = static_cast<double>(q.w());
  return std::fabs(x * x + y * y + z * z + w * w - 1) <= kUnitTolerance;
}

/// Finite translation and unit rotation.
[[nodiscard]] inline bool isRigid(const schema::Pose& pose) {
  return isFinite(pose.translation()) && isUnit(pose.rotation());
}

/// Finite, and no minimum above its maximum.
[[nodiscard]] Result<void> checkBounds(const schema::Bounds* bounds, const std::string& where);

/// Counts that add up.
[[nodiscard]] Result<void> checkImport(const schema::ImportStatistics& counts,
                                       const std::string& where);

/// 1 to 8 ascending lengths.
[[nodiscard]] Result<void> checkRadii(const flatbuffers::Vector<float>& radii,
                                      const std::string& where);

/// Finite centres, radii of the working set, in the order of the schema from `begin` to `end`.
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

/// Finite positions, whole triangles of existing corners, a colour for each vertex or none.
[[nodiscard]] Result<void> checkSurface(const schema::Surface& surface, const std::string& where);

}  // namespace galactic::detail
