#include <fmt/format.h>

#include <algorithm>

#include "galactic/bake/packs.h"
#include "support/try.h"
#include "write/pack_payload.h"
#include "write/render_meshes.h"

namespace galactic::bake {
namespace {

schema::BoxFit toSchema(BoxFit fit) {
  switch (fit) {
    case BoxFit::kYaw:
      return schema::BoxFit::Yaw;
    case BoxFit::kMinimum:
      return schema::BoxFit::Minimum;
    case BoxFit::kAxisAligned:
      return schema::BoxFit::AxisAligned;
  }
  return schema::BoxFit::Yaw;
}

Offset<schema::Object> objectTable(FlatBufferBuilder& builder, const BakedObject& object) {
  const auto name = builder.CreateString(object.name);
  const auto spheres = alignedStructs<schema::SetSphere>(builder, object.spheres.spheres);
  const auto statistics =
      sphereStatistics(builder, object.spheres,
                       {.eps = object.eps, .tau = object.tau, .authored = object.authored_spheres});
  const auto stable_poses = alignedStructs<schema::StablePose>(builder, object.stable_poses);
  const auto imported = importStatistics(builder, object.imported);
  const auto surface = surfaceTable(builder, object.surface);
  // Stores no planes if the hull fills the box.
  const auto hull_planes = object.hull_planes.empty()
                               ? Offset<flatbuffers::Vector<const schema::HullPlane*>>{}
                               : alignedStructs<schema::HullPlane>(builder, object.hull_planes);
  const schema::Pose box_pose = bake::toSchema(object.box.box.pose);
  const schema::Vec3 half_extents = bake::toSchema(object.box.box.half_extents);
  const schema::BoxStatistics volumes(object.box.volume, object.box.axis_aligned_volume,
                                      object.box.pca_volume);
  const schema::Bounds bounds = bake::toSchema(object.bounds);
  return schema::CreateObject(builder, name, &box_pose, &half_extents, toSchema(object.box.used),
                              &volumes, spheres, statistics, stable_poses, &bounds, imported,
                              surface, hull_planes);
}

/// The render meshes of all objects merged into one; none if no object has any.
Result<std::optional<BakedRenderMeshes>> mergedMeshes(
    const std::vector<const BakedObject*>& objects) {
  constexpr std::size_t kMostMaterials = 65536;
  std::optional<BakedRenderMeshes> merged;
  std::size_t materials = 0;
  for (std::size_t n = 0; n < objects.size(); ++n) {
    const auto& meshes = objects[n]->render_meshes;
    if (!meshes) continue;
    materials += meshes->materials.materials.size();
    if (materials > kMostMaterials) {
      return fail(ErrorCode::kUnsupported, "",
                  fmt::format("the objects have over {} materials; bake them into several packs",
                              kMostMaterials));
    }
    if (!merged) merged.emplace();
    append(*merged, *meshes, static_cast<std::uint32_t>(n));
  }
  return merged;
}

}  // namespace

Result<std::vector<std::byte>> encodeObjectPack(const BakedObjectSet& set,
                                                const Provenance& provenance) {
  std::vector<const BakedObject*> objects;
  std::uint64_t bytes = 0;
  for (const BakedObject& object : set.objects) {
    objects.push_back(&object);
    bytes += storedBytes(object.surface);
    if (object.render_meshes) bytes += object.render_meshes->storedBytes();
  }
  if (bytes > kMaxSurfaceBytes) {
    return fail(ErrorCode::kUnsupported, "",
                fmt::format("the objects need {} MB, one pack holds less than 2048 MB; bake them "
                            "into several packs",
                            bytes >> 20U));
  }
  if (objects.empty()) {
    return fail(ErrorCode::kInvalidInput, "", "there are no objects for the pack; give some");
  }
  std::sort(objects.begin(), objects.end(),
            [](const BakedObject* a, const BakedObject* b) { return a->name < b->name; });
  if (objects.front()->name.empty()) {
    return fail(ErrorCode::kInvalidInput, "", "an object has no name; give it one");
  }
  const auto same = std::adjacent_find(
      objects.begin(), objects.end(),
      [](const BakedObject* a, const BakedObject* b) { return a->name == b->name; });
  if (same != objects.end()) {
    return fail(ErrorCode::kInvalidInput, (*same)->name,
                "is the name of two objects; rename one of the files or folders");
  }
  FlatBufferBuilder builder(static_cast<std::size_t>(bytes) + 65536);
  const auto meshes = mergedMeshes(objects);
  if (!meshes) return tl::unexpected(meshes.error());
  const auto provenance_table = provenanceTable(builder, provenance);
  std::vector<Offset<schema::Object>> tables;
  tables.reserve(objects.size());
  for (const BakedObject* object : objects) tables.push_back(objectTable(builder, *object));
  const auto table_vector = builder.CreateVector(tables);
  Offset<schema::RenderMeshes> render_meshes;
  if (*meshes) render_meshes = renderMeshesTable(builder, **meshes);
  const auto radii = builder.CreateVector(set.radii);
  const auto root = schema::CreateObjectSet(builder, radii, table_vector, render_meshes);
  return finishPack(builder, provenance_table, schema::Asset::ObjectSet, root.Union());
}

Result<std::uint64_t> writeObjectPack(const std::filesystem::path& path, const BakedObjectSet& set,
                                      const Provenance& provenance) {
  ASSIGN_OR_RETURN(const auto payload, encodeObjectPack(set, provenance));
  return writePackFile(path, PackKind::kObjects, payload);
}

}  // namespace galactic::bake
