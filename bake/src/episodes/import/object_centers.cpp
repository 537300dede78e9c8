#include "galactic/bake/episode_set_import.h"
#include "galactic/object_set.h"
#include "galactic/schema/pack_generated.h"
#include "support/try.h"

namespace galactic::bake {

Result<std::map<std::string, Vec3>> objectCenters(const PackFile& objects) {
  RETURN_IF_ERROR(ObjectSet::from(objects));
  std::map<std::string, Vec3> centers;
  for (const schema::Object* object : *objects.root().asset_as_ObjectSet()->objects()) {
    const schema::Bounds* bounds = object->bounds();
    if (bounds == nullptr) continue;  // Only in files that were not verified.
    const schema::Vec3& low = bounds->min();
    const schema::Vec3& high = bounds->max();
    centers[object->name()->str()] =
        Vec3{low.x() + high.x(), low.y() + high.y(), low.z() + high.z()} * 0.5F;
  }
  return centers;
}

}  // namespace galactic::bake
