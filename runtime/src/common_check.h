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

/// Length 1 within the rounding of floats.
[[nodiscard]] bool isUnit(const schema::Vec3& v);
[[nodiscard]] bool isUnit(const schema::Quat& q);
/// Finite translation and unit rotation.
[[nodiscard]] bool isRigid(const schema::Pose& pose);

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
