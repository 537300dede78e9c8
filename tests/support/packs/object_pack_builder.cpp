#include "support/packs/object_pack_builder.h"

#include "support/packs/schema_parts.h"

namespace galactic::test {
namespace {

flatbuffers::Offset<schema::Object> buildObject(flatbuffers::FlatBufferBuilder& builder,
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
  flatbuffers::Offset<flatbuffers::Vector<const schema::HullPlane*>> hull_planes;
  if (fields.hull_planes) {
    std::vector<schema::HullPlane> planes;
    for (const HullPlane& plane : *fields.hull_planes) {
      planes.emplace_back(stored(plane.normal), plane.offset);
    }
    hull_planes = alignedStructs(builder, planes);
  }
  return schema::CreateObject(
      builder, name, fields.box_pose ? &pose : nullptr,
      fields.box_half_extents ? &half_extents : nullptr,
      static_cast<schema::BoxFit>(fields.box_fit), fields.box_statistics ? &box : nullptr, spheres,
      statistics, pose_vector, fields.bounds ? &bounds : nullptr, import, surface, hull_planes);
}

}  // namespace

ObjectPackFields smallObjects() {
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

AlignedBytes buildPack(const ObjectPackFields& fields) {
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
