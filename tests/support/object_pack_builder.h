#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "galactic/stable_pose.h"
#include "support/pack_parts.h"
#include "support/render_pack_builder.h"

namespace galactic::test {

struct BoxVolumeFields {
  double volume = 0.001;
  double axis_aligned = 0.002;
  double pca = 0.0015;
};

struct BoundsFields {
  Vec3 min{-0.1F, 0, -0.1F};
  Vec3 max{0.1F, 0.2F, 0.1F};
};

/// One object of a pack.
struct ObjectFields {
  std::string name = "mug";
  std::optional<Pose> box_pose = Pose{{0, 0.1F, 0}, {0, 0, 0, 1}};
  std::optional<Vec3> box_half_extents = Vec3{0.1F, 0.1F, 0.1F};
  std::uint8_t box_fit = 0;
  std::optional<BoxVolumeFields> box_statistics = BoxVolumeFields{};
  std::vector<SetSphere> spheres{
      {{0, 0.1F, 0}, 1}, {{-0.05F, 0.05F, 0}, 0}, {{0.05F, 0.05F, 0}, 0}, {{0.05F, 0.06F, 0}, 0}};
  SphereStatisticsFields statistics;
  std::vector<StablePose> stable_poses{{{0, 0, 0, 1}, 0, 0.75F}, {{1, 0, 0, 0}, 0.2F, 0.25F}};
  std::optional<BoundsFields> bounds = BoundsFields{};
  std::string format = "Wavefront OBJ";
  std::uint64_t triangles_read = 6;
  std::uint64_t triangles_degenerate = 1;
  std::uint64_t triangles = 5;
  SurfaceFields surface;
};

/// All that an object pack holds. buildPack makes a pack that is valid in every field that was left
/// as it is.
struct ObjectPackFields {
  PackKind kind = PackKind::kObjects;
  std::vector<float> radii{0.015F, 0.05F};
  std::vector<ObjectFields> objects;
  RenderMeshesField render_meshes;
};

/// Two objects; the second one without colours, with one sphere and one pose.
inline ObjectPackFields smallObjects() {
  ObjectPackFields fields;
  fields.objects.resize(2);
  fields.objects[0].name = "bowl";
  fields.objects[1].name = "mug";
  fields.objects[1].spheres.resize(1);
  fields.objects[1].stable_poses.resize(1);
  fields.objects[1].surface.colors.clear();
  fields.objects[1].box_fit = 1;
  return fields;
}

inline flatbuffers::Offset<schema::Object> buildObject(flatbuffers::FlatBufferBuilder& builder,
                                                       const ObjectFields& fields) {
  const schema::Pose pose = stored(fields.box_pose.value_or(Pose{}));
  const schema::Vec3 half_extents = stored(fields.box_half_extents.value_or(Vec3{}));
  const BoxVolumeFields volumes = fields.box_statistics.value_or(BoxVolumeFields{});
  const schema::BoxStatistics box(volumes.volume, volumes.axis_aligned, volumes.pca);
  const BoundsFields corners = fields.bounds.value_or(BoundsFields{});
  const schema::Bounds bounds(stored(corners.min), stored(corners.max));
  const auto name = builder.CreateString(fields.name);
  const auto spheres = buildSpheres(builder, fields.spheres);
  const auto statistics = buildStatistics(builder, fields.statistics);
  std::vector<schema::StablePose> poses;
  for (const StablePose& stable : fields.stable_poses) {
    poses.emplace_back(stored(stable.rotation), stable.height, stable.likelihood);
  }
  const auto pose_vector = alignedStructs(builder, poses);
  const auto import = schema::CreateImportStatistics(
      builder, builder.CreateString(fields.format), 1, 1, fields.triangles_read,
      fields.triangles_degenerate, 0, fields.triangles);
  const auto surface = buildSurface(builder, fields.surface);
  return schema::CreateObject(builder, name, fields.box_pose ? &pose : nullptr,
                              fields.box_half_extents ? &half_extents : nullptr,
                              static_cast<schema::BoxFit>(fields.box_fit),
                              fields.box_statistics ? &box : nullptr, spheres, statistics,
                              pose_vector, fields.bounds ? &bounds : nullptr, import, surface);
}

/// The whole file: header and payload.
inline AlignedBytes buildPack(const ObjectPackFields& fields) {
  flatbuffers::FlatBufferBuilder builder;
  std::vector<flatbuffers::Offset<schema::Object>> objects;
  for (const ObjectFields& object : fields.objects) {
    objects.push_back(buildObject(builder, object));
  }
  const auto object_vector = builder.CreateVector(objects);
  const auto radii = builder.CreateVector(fields.radii);
  const auto meshes = buildRenderMeshesField(builder, fields.render_meshes);
  const auto set = schema::CreateObjectSet(builder, radii, object_vector, meshes);
  return finishFile(builder, fields.kind, schema::Asset::ObjectSet, set.Union());
}

}  // namespace galactic::test
