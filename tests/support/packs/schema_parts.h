#pragma once
#include <vector>

#include "galactic/pose.h"
#include "galactic/schema/pack_generated.h"
#include "support/packs/pack_parts.h"
#include "support/packs/render_pack_builder.h"

namespace galactic::test {

// For the sources that build packs alone: whoever includes this compiles the schema.

schema::Vec3 stored(const Vec3& v);

schema::Quat stored(const Quat& q);

schema::Pose stored(const Pose& pose);

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

flatbuffers::Offset<flatbuffers::Vector<const schema::SetSphere*>> buildSpheres(
    flatbuffers::FlatBufferBuilder& builder, const std::vector<SetSphere>& spheres);

flatbuffers::Offset<schema::SphereSetStatistics> buildStatistics(
    flatbuffers::FlatBufferBuilder& builder, const SphereStatisticsFields& fields);

flatbuffers::Offset<schema::Surface> buildSurface(flatbuffers::FlatBufferBuilder& builder,
                                                  const SurfaceFields& fields);

/// Nothing where there are none.
flatbuffers::Offset<schema::RenderMeshes> buildRenderMeshesField(
    flatbuffers::FlatBufferBuilder& builder, const RenderMeshesField& field);

/// The whole file of a pack of this kind: header, provenance, asset.
AlignedBytes finishFile(flatbuffers::FlatBufferBuilder& builder, PackKind kind, schema::Asset type,
                        flatbuffers::Offset<void> asset);

}  // namespace galactic::test
