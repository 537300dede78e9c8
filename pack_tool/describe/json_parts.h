#pragma once
#include <cstddef>
#include <span>
#include <string>

#include "galactic/pose.h"
#include "galactic/schema/pack_generated.h"
#include "galactic/shapes.h"
#include "pack_tool/describe/pack_description.h"

namespace galactic::pack_tool {

// What the descriptions of several kinds of packs share.

/// (x, y, z).
[[nodiscard]] Json describePoint(const Vec3& point);
[[nodiscard]] Json describePoint(const schema::Vec3& point);

/// Translation (x, y, z) and rotation in the order of text, (w, x, y, z).
[[nodiscard]] Json describeRotation(const schema::Quat& rotation);
[[nodiscard]] Json describePose(const schema::Pose& pose);

[[nodiscard]] Json describeImport(const schema::ImportStatistics& statistics);

/// "radii" of the working set.
[[nodiscard]] Json describeRadii(const flatbuffers::Vector<float>& radii);

/// The spheres [first, first + count), each with its center and radius.
struct SphereRange {
  std::size_t first = 0;
  std::size_t count = 0;
};
[[nodiscard]] Json describeSpheres(const flatbuffers::Vector<const schema::SetSphere*>& spheres,
                                   const SphereRange& range,
                                   const flatbuffers::Vector<float>& radii);

/// Null without statistics.
[[nodiscard]] Json describeQuality(const schema::SphereSetStatistics* statistics);

/// How large a mesh is, and a hash (FNV-1a, 64 bits) of its vertices, triangles and colors; null
/// without one.
[[nodiscard]] Json describeSurface(const schema::Surface* surface);

/// FNV-1a, 64 bits, in 16 hexadecimal digits.
[[nodiscard]] std::string contentHash(std::span<const std::byte> bytes);

/// An XXH3-128 hash in 32 hexadecimal digits, high half first; null without one.
[[nodiscard]] Json describeHash(const schema::Hash128* hash);

/// A list of texts.
[[nodiscard]] Json describeTexts(
    const flatbuffers::Vector<flatbuffers::Offset<flatbuffers::String>>& texts);

}  // namespace galactic::pack_tool
