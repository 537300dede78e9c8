#include "check/asset_checks.h"
#include "check/common_check.h"
#include "check/offence.h"
#include "check/render_check.h"

namespace galactic::detail {
namespace {

Result<void> checkBox(const schema::Object& object, const std::string& where) {
  Offence offence(where);
  offence.require(object.box_pose() != nullptr && isRigid(*object.box_pose()), "box_pose",
                  "is missing or not a rigid transform, expected up to {} m and a unit quaternion",
                  kFarthest);
  const schema::Vec3* half = object.box_half_extents();
  offence.require(
      half != nullptr && isLength(half->x()) && isLength(half->y()) && isLength(half->z()),
      "box_half_extents", "are missing or not lengths, expected more than 0 and up to {} m",
      kFarthest);
  offence.require(object.box_fit() <= schema::BoxFit::MAX, "box_fit",
                  "is {}, expected a value up to {}", static_cast<unsigned>(object.box_fit()),
                  static_cast<unsigned>(schema::BoxFit::MAX));
  const schema::BoxStatistics* volumes = object.box_statistics();
  offence.require(volumes != nullptr && isAmount(volumes->volume()) &&
                      isAmount(volumes->axis_aligned_volume()) && isAmount(volumes->pca_volume()),
                  "box_statistics", "are missing or not finite, expected volumes of 0 or more");
  return offence.result();
}

Result<void> checkStablePoses(const schema::Object& object, const std::string& where) {
  const auto& poses = *object.stable_poses();
  Offence offence(where);
  offence.require(poses.size() >= 1, "stable_poses", "is empty, expected at least one pose");
  for (flatbuffers::uoffset_t n = 0; n < poses.size() && !offence.found(); ++n) {
    const schema::StablePose& pose = *poses.Get(n);
    const std::string field = fmt::format("stable_poses[{}]", n);
    offence.require(isUnit(pose.rotation()), field + ".rotation",
                    "is not a unit quaternion, expected a rotation");
    offence.require(isPlaneOffset(pose.height()), field + ".height", "is {} m, expected up to {} m",
                    pose.height(), kFarthestPlane);
    const float most = n == 0 ? 1.0F : poses.Get(n - 1)->likelihood();
    offence.require(pose.likelihood() >= 0 && pose.likelihood() <= most, field + ".likelihood",
                    "is {}, expected 0 to {}: the likeliest first", pose.likelihood(), most);
  }
  return offence.result();
}

/// Limits what a grasp has to examine: many planes would make it slow.
constexpr flatbuffers::uoffset_t kMostHullPlanes = 128;

Result<void> checkHullPlanes(const schema::Object& object, const std::string& where) {
  Offence offence(where);
  const auto* planes = object.hull_planes();
  if (planes == nullptr) return offence.result();
  offence.require(planes->size() <= kMostHullPlanes, "hull_planes",
                  "has {} planes, expected up to {}", planes->size(), kMostHullPlanes);
  for (flatbuffers::uoffset_t n = 0; n < planes->size() && !offence.found(); ++n) {
    const schema::HullPlane& plane = *planes->Get(n);
    const std::string field = fmt::format("hull_planes[{}]", n);
    offence.require(isUnit(plane.normal()), field + ".normal",
                    "is not of unit length, expected a direction");
    offence.require(isPlaneOffset(plane.offset()), field + ".offset",
                    "is {} m, expected up to {} m", plane.offset(), kFarthestPlane);
  }
  return offence.result();
}

Result<void> checkObject(const schema::Object& object, std::size_t radii,
                         const std::string& where) {
  Offence offence(where);
  offence.require(!isEmpty(object.name()), "name", "is empty, expected the object's name");
  offence.require(checkBox(object, where));
  offence.require(object.spheres()->size() >= 1, "spheres",
                  "is empty, expected at least one sphere");
  offence.require(checkSpheres(*object.spheres(), {0, object.spheres()->size()}, radii, where));
  offence.require(checkSphereStatistics(*object.sphere_statistics(), where + ".sphere_statistics"));
  offence.require(checkStablePoses(object, where));
  offence.require(checkBounds(object.bounds(), where));
  offence.require(checkImport(*object.import_statistics(), where));
  offence.require(checkSurface(*object.surface(), where + ".surface"));
  offence.require(checkHullPlanes(object, where));
  return offence.result();
}

}  // namespace

Result<void> checkObjectSet(const schema::ObjectSet& set, const std::string& where) {
  Offence offence(where + ": objects");
  offence.require(checkRadii(*set.radii(), offence.where()));
  const auto& objects = *set.objects();
  offence.require(objects.size() >= 1, "objects", "is empty, expected at least one object");
  for (flatbuffers::uoffset_t n = 0; n < objects.size() && !offence.found(); ++n) {
    const std::string field = fmt::format("objects[{}]", n);
    offence.require(
        checkObject(*objects.Get(n), set.radii()->size(), offence.where() + "." + field));
    if (n == 0) continue;
    offence.require(
        objects.Get(n - 1)->name()->string_view() < objects.Get(n)->name()->string_view(),
        field + ".name", "does not come after its predecessor's, expected ascending names");
  }
  if (set.render_meshes() != nullptr && !offence.found()) {
    offence.require(checkRenderMeshes(*set.render_meshes(), objects.size(), offence.where()));
  }
  return offence.result();
}

}  // namespace galactic::detail
