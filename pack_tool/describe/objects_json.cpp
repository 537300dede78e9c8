#include <fmt/format.h>

#include <string>

#include "pack_tool/describe/asset_json.h"
#include "pack_tool/describe/json_parts.h"

namespace galactic::pack_tool {

namespace {

std::string fitName(schema::BoxFit fit) {
  switch (fit) {
    case schema::BoxFit::Yaw:
      return "yaw";
    case schema::BoxFit::Minimum:
      return "min";
    case schema::BoxFit::AxisAligned:
      return "aabb";
  }
  return fmt::format("unknown ({})", static_cast<unsigned>(fit));
}

Json describeBox(const schema::Object& object) {
  Json json = describePose(*object.box_pose());
  json["half_extents"] = describePoint(*object.box_half_extents());
  json["fit"] = fitName(object.box_fit());
  return json;
}

Json describeVolumes(const schema::BoxStatistics& statistics) {
  return {{"volume", statistics.volume()},
          {"axis_aligned_volume", statistics.axis_aligned_volume()},
          {"pca_volume", statistics.pca_volume()}};
}

Json describePoses(const schema::Object& object) {
  Json json = Json::array();
  for (const schema::StablePose* pose : *object.stable_poses()) {
    json.push_back({{"rotation_wxyz", describeRotation(pose->rotation())},
                    {"height", jsonNumber(pose->height())},
                    {"likelihood", jsonNumber(pose->likelihood())}});
  }
  return json;
}

Json describeHullPlanes(const schema::Object& object) {
  Json json = Json::array();
  if (object.hull_planes() == nullptr) return json;
  for (const schema::HullPlane* plane : *object.hull_planes()) {
    json.push_back(
        {{"normal", describePoint(plane->normal())}, {"offset", jsonNumber(plane->offset())}});
  }
  return json;
}

Json describeObject(const schema::Object& object, const flatbuffers::Vector<float>& radii) {
  Json json;
  json["name"] = object.name()->str();
  json["bounds"] = {{"min", describePoint(object.bounds()->min())},
                    {"max", describePoint(object.bounds()->max())}};
  json["box"] = describeBox(object);
  json["stable_poses"] = describePoses(object);
  json["hull_planes"] = describeHullPlanes(object);
  json["spheres"] = describeSpheres(*object.spheres(), {0, object.spheres()->size()}, radii);
  json["box_volumes"] = describeVolumes(*object.box_statistics());
  json["sphere_quality"] = describeQuality(object.sphere_statistics());
  json["import"] = describeImport(*object.import_statistics());
  json["surface"] = describeSurface(object.surface());
  return json;
}

}  // namespace

Json describeObjects(const PackFile& pack) {
  const schema::ObjectSet* set = pack.root().asset_as_ObjectSet();
  if (set == nullptr) return nullptr;
  Json json;
  json["radii"] = describeRadii(*set->radii());
  json["objects"] = Json::array();
  for (const schema::Object* object : *set->objects()) {
    json["objects"].push_back(describeObject(*object, *set->radii()));
  }
  return json;
}

}  // namespace galactic::pack_tool
