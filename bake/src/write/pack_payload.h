#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "galactic/bake/oriented_box.h"
#include "galactic/bake/source_asset.h"
#include "galactic/bake/sphere_set.h"
#include "galactic/bake/triangle_mesh.h"
#include "galactic/error.h"
#include "galactic/pack_header.h"
#include "galactic/pose.h"
#include "galactic/schema/pack_generated.h"

namespace galactic::bake {

// Helpers shared by the writers of all kinds of packs. Build each table in its own statement and
// not inside the arguments of a call: the compiler chooses the order in which arguments are
// evaluated, and the order in which tables are built determines the bytes.

using flatbuffers::FlatBufferBuilder;
using flatbuffers::Offset;

/// The greatest alignment that FlatBuffers 2.0 supports.
inline constexpr std::size_t kVectorAlignment = 32;

[[nodiscard]] inline schema::Vec3 toSchema(const Vec3& v) { return {v.x, v.y, v.z}; }
[[nodiscard]] inline schema::Quat toSchema(const Quat& q) { return {q.x, q.y, q.z, q.w}; }
[[nodiscard]] inline schema::Pose toSchema(const Pose& pose) {
  return {toSchema(pose.translation), toSchema(pose.rotation)};
}
[[nodiscard]] inline schema::Bounds toSchema(const Bounds& bounds) {
  return {toSchema(bounds.min), toSchema(bounds.max)};
}

/// A vector of numbers with the alignment that the runtime needs.
template <class T>
[[nodiscard]] Offset<flatbuffers::Vector<T>> alignedVector(FlatBufferBuilder& builder,
                                                           std::span<const T> values) {
  builder.ForceVectorAlignment(values.size(), sizeof(T), kVectorAlignment);
  return builder.CreateVector(values.data(), values.size());
}

/// A vector of our structs, which have the same layout as the schema's struct `Stored`.
template <class Stored, class Structs>
[[nodiscard]] Offset<flatbuffers::Vector<const Stored*>> alignedStructs(FlatBufferBuilder& builder,
                                                                        const Structs& values) {
  static_assert(sizeof(typename Structs::value_type) == sizeof(Stored));
  builder.ForceVectorAlignment(values.size(), sizeof(Stored), kVectorAlignment);
  return builder.CreateVectorOfStructs(reinterpret_cast<const Stored*>(values.data()),
                                       values.size());
}

[[nodiscard]] Offset<schema::Provenance> provenanceTable(FlatBufferBuilder& builder,
                                                         const Provenance& provenance);

[[nodiscard]] Offset<schema::ImportStatistics> importStatistics(FlatBufferBuilder& builder,
                                                                const ImportStatistics& statistics);

[[nodiscard]] Offset<schema::Surface> surfaceTable(FlatBufferBuilder& builder,
                                                   const Surface& surface);

/// Limit for surfaces: FlatBuffers offsets are signed 32-bit, and everything else in a pack is
/// small.
inline constexpr std::uint64_t kMaxSurfaceBytes =
    (std::uint64_t{1} << 31U) - (std::uint64_t{64} << 20U);

/// Bytes that a surface takes in a pack.
[[nodiscard]] inline std::uint64_t storedBytes(const Surface& surface) {
  return surface.positions.size() * sizeof(Vec3) + surface.triangles.size() * sizeof(Triangle) +
         surface.colors.size() * sizeof(std::uint32_t);
}

/// The tolerances requested for a sphere set.
struct SphereTolerances {
  float eps = 0;
  float tau = 0;
  bool authored = false;
};

[[nodiscard]] Offset<schema::SphereSetStatistics> sphereStatistics(FlatBufferBuilder& builder,
                                                                   const SphereSet& set,
                                                                   const SphereTolerances& asked);

/// Finishes and returns the payload of a pack.
[[nodiscard]] std::vector<std::byte> finishPack(FlatBufferBuilder& builder,
                                                Offset<schema::Provenance> provenance,
                                                schema::Asset type, Offset<void> asset);

/// Writes header and payload atomically and returns the file's size in bytes. Fails with kInternal,
/// and writes nothing, if the result does not pass the checks made when a pack is opened.
[[nodiscard]] Result<std::uint64_t> writePackFile(const std::filesystem::path& path, PackKind kind,
                                                  std::span<const std::byte> payload);

}  // namespace galactic::bake
