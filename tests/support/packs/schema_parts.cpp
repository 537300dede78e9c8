#include "support/packs/schema_parts.h"

#include <string>

namespace galactic::test {

schema::Vec3 stored(const Vec3& v) { return {v.x, v.y, v.z}; }

schema::Quat stored(const Quat& q) { return {q.x, q.y, q.z, q.w}; }

schema::Pose stored(const Pose& pose) { return {stored(pose.translation), stored(pose.rotation)}; }

flatbuffers::Offset<flatbuffers::Vector<const schema::SetSphere*>> buildSpheres(
    flatbuffers::FlatBufferBuilder& builder, const std::vector<SetSphere>& spheres) {
  std::vector<schema::SetSphere> made;
  for (const SetSphere& sphere : spheres) {
    made.emplace_back(stored(sphere.center), sphere.radius_index);
  }
  return alignedStructs(builder, made);
}

flatbuffers::Offset<schema::SphereSetStatistics> buildStatistics(
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

flatbuffers::Offset<schema::Surface> buildSurface(flatbuffers::FlatBufferBuilder& builder,
                                                  const SurfaceFields& fields) {
  std::vector<schema::Vec3> positions;
  for (const Vec3& position : fields.positions) positions.push_back(stored(position));
  const auto position_vector = alignedStructs(builder, positions);
  const auto triangles = alignedNumbers(builder, fields.triangles);
  const auto colors = alignedNumbers(builder, fields.colors);
  return schema::CreateSurface(builder, position_vector, triangles, colors);
}

AlignedBytes finishFile(flatbuffers::FlatBufferBuilder& builder, PackKind kind, schema::Asset type,
                        flatbuffers::Offset<void> asset) {
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
  return packFile(kind, {payload, builder.GetSize()});
}

}  // namespace galactic::test
