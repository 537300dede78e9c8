#pragma once
#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "galactic/pack_header.h"
#include "galactic/pose.h"
#include "galactic/schema/pack_generated.h"
#include "galactic/sphere_set.h"
#include "support/aligned_bytes.h"
#include "support/scene_pack_builder.h"

namespace galactic::test {

// What the hand-made packs of objects and robots share. Everything is valid as it is declared; a
// test changes what it wants to be wrong. std::nullopt leaves a field out.

struct LengthFields {
  double mean = 0.001;
  double p95 = 0.002;
  double max = 0.004;
};

struct SphereStatisticsFields {
  float eps = 0.015F;
  float tau = 0.02F;
  std::optional<LengthFields> gap = LengthFields{};
  std::optional<LengthFields> protrusion = LengthFields{};
  double volume_ratio = 1.25;
  double guaranteed_gap = 0.015;
  double guaranteed_protrusion = 0.02;
};

/// A tetrahedron with a colour for each corner.
struct SurfaceFields {
  std::vector<Vec3> positions{{0, 0, 0}, {0.1F, 0, 0}, {0, 0.1F, 0}, {0, 0, 0.1F}};
  std::vector<std::uint32_t> triangles{0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
  std::vector<std::uint32_t> colors{0xff0000ff, 0xff00ff00, 0xffff0000, 0xffffffff};
};

inline schema::Vec3 stored(const Vec3& v) { return {v.x, v.y, v.z}; }
inline schema::Quat stored(const Quat& q) { return {q.x, q.y, q.z, q.w}; }
inline schema::Pose stored(const Pose& pose) {
  return {stored(pose.translation), stored(pose.rotation)};
}

/// A vector aligned as the schema says.
template <class T>
auto alignedNumbers(flatbuffers::FlatBufferBuilder& builder, const std::vector<T>& values) {
  builder.ForceVectorAlignment(values.size(), sizeof(T), 32);
  return builder.CreateVector(values);
}

template <class T>
auto alignedStructs(flatbuffers::FlatBufferBuilder& builder, const std::vector<T>& values) {
  builder.ForceVectorAlignment(values.size(), sizeof(T), 32);
  return builder.CreateVectorOfStructs(values);
}

/// Puts the spheres of one set in the order that packs want.
inline void sortSpheres(std::span<SetSphere> spheres) {
  const auto key = [](const SetSphere& sphere) {
    const Vec3& at = sphere.centre;
    return std::tuple(-static_cast<std::int64_t>(sphere.radius_index), at.x, at.y, at.z);
  };
  std::sort(spheres.begin(), spheres.end(),
            [&](const SetSphere& a, const SetSphere& b) { return key(a) < key(b); });
}

inline auto buildSpheres(flatbuffers::FlatBufferBuilder& builder,
                         const std::vector<SetSphere>& spheres) {
  std::vector<schema::SetSphere> made;
  for (const SetSphere& sphere : spheres) {
    made.emplace_back(stored(sphere.centre), sphere.radius_index);
  }
  return alignedStructs(builder, made);
}

inline flatbuffers::Offset<schema::SphereSetStatistics> buildStatistics(
    flatbuffers::FlatBufferBuilder& builder, const SphereStatisticsFields& fields) {
  const auto lengths = [](const std::optional<LengthFields>& made) {
    const LengthFields values = made.value_or(LengthFields{});
    return schema::LengthStatistics(values.mean, values.p95, values.max);
  };
  const schema::LengthStatistics gap = lengths(fields.gap);
  const schema::LengthStatistics protrusion = lengths(fields.protrusion);
  return schema::CreateSphereSetStatistics(
      builder, fields.eps, fields.tau, fields.gap ? &gap : nullptr,
      fields.protrusion ? &protrusion : nullptr, fields.volume_ratio, 2, 4096,
      fields.guaranteed_gap, fields.guaranteed_protrusion, true, false);
}

inline flatbuffers::Offset<schema::Surface> buildSurface(flatbuffers::FlatBufferBuilder& builder,
                                                         const SurfaceFields& fields) {
  std::vector<schema::Vec3> positions;
  for (const Vec3& position : fields.positions) positions.push_back(stored(position));
  const auto position_vector = alignedStructs(builder, positions);
  const auto triangles = alignedNumbers(builder, fields.triangles);
  const auto colors = alignedNumbers(builder, fields.colors);
  return schema::CreateSurface(builder, position_vector, triangles, colors);
}

/// The whole file of a pack of this kind: header, provenance, asset.
inline AlignedBytes finishFile(flatbuffers::FlatBufferBuilder& builder, PackKind kind,
                               schema::Asset type, flatbuffers::Offset<void> asset) {
  const schema::Hash128 hash(1, 2);
  const auto name = builder.CreateString("input.obj");
  const auto source = schema::CreateSourceFile(builder, name, 1234, &hash);
  const auto provenance = schema::CreateProvenance(
      builder, builder.CreateString("galactic-bake"), builder.CreateString("0.1.0"),
      builder.CreateVector(std::vector<flatbuffers::Offset<schema::Option>>{}),
      builder.CreateVector(std::vector{source}),
      builder.CreateVector(std::vector<flatbuffers::Offset<flatbuffers::String>>{}));
  schema::FinishPackBuffer(builder, schema::CreatePack(builder, provenance, type, asset));
  const auto* payload = reinterpret_cast<const std::byte*>(builder.GetBufferPointer());
  return ScenePackBuilder::withHeader(kind, {payload, builder.GetSize()});
}

}  // namespace galactic::test
