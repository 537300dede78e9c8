#include "galactic/object_set.h"

#include <algorithm>
#include <string>

#include "pack/schema_values.h"

namespace galactic {

static_assert(sizeof(StablePose) == sizeof(schema::StablePose));
static_assert(sizeof(HullPlane) == sizeof(schema::HullPlane));

Result<ObjectSet> ObjectSet::from(const PackFile& pack) {
  const schema::ObjectSet* stored =
      pack.kind() == PackKind::kObjects ? pack.root().asset_as_ObjectSet() : nullptr;
  if (stored == nullptr) {
    return fail(ErrorCode::kInvalidInput, pack.where(),
                "is a pack of kind " + packKindName(pack.kind()) +
                    ", expected objects (OBJS); give the pack of an object set");
  }
  ObjectSet set;
  set.radii_ = detail::inPlace<float>(stored->radii());
  set.objects_.reserve(stored->objects()->size());
  for (const schema::Object* object : *stored->objects()) {
    ObjectModel& model = set.objects_.emplace_back();
    model.name = detail::fromSchema(object->name());
    model.box = {detail::fromSchema(*object->box_pose()),
                 detail::fromSchema(*object->box_half_extents())};
    model.spheres = detail::inPlace<SetSphere>(object->spheres());
    model.stable_poses = detail::inPlace<StablePose>(object->stable_poses());
    if (object->hull_planes() != nullptr) {
      model.hull_planes = detail::inPlace<HullPlane>(object->hull_planes());
    }
  }
  return set;
}

std::optional<std::size_t> ObjectSet::find(std::string_view name) const {
  const auto found = std::lower_bound(
      objects_.begin(), objects_.end(), name,
      [](const ObjectModel& object, std::string_view wanted) { return object.name < wanted; });
  if (found == objects_.end() || found->name != name) return std::nullopt;
  return static_cast<std::size_t>(found - objects_.begin());
}

}  // namespace galactic
