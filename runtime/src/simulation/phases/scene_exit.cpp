#include "simulation/phases/scene_exit.h"

#include <algorithm>
#include <bit>

#include "simulation/phases/move.h"

namespace galactic::simulation {

SceneExit::SceneExit(const ChunkStep& step, std::size_t e)
    : step_(step),
      e_(e),
      env_(step.state.env(step.first + e)),
      scene_(step.model.scenes[env_.scene]),
      scratch_(step.chunk.sceneExit()) {
  begin();
}

void SceneExit::begin() {
  scratch_.way.clear(scene_.grids().front().spacing());
  forgetGroups();
  moved_ = {};
}

void SceneExit::follow(const Push& moved, bool is_level) {
  if (!is_level) forgetGroups();
  moved_ = moved;
}

/// Forgets which groups suit a way, and which are in columns.
void SceneExit::forgetGroups() {
  std::ranges::fill(scratch_.suited, 0U);
  if (asks_columns_) clearColumns();
}

void SceneExit::clearColumns() {
  scratch_.columns.clear();
  std::ranges::fill(scratch_.in_columns, 0U);
  holds_columns_ = false;
}

bool SceneExit::addBlocked(Hindrance met) {
  // The last query stopped at the floor, which is too high, before it reached the scene.
  if (met == Hindrance::kRise) findBlocked(step_, e_, suited());
  const bool body = met == Hindrance::kRise || met == Hindrance::kScene;
  if (!body && !heldIsBlocked()) return false;
  if (asks_columns_) {
    addColumns(met);
    return true;
  }
  if (met == Hindrance::kRise) addSphere(0, floorProbeHere());
  if (body) {
    addBody();
  } else {
    addHeld();
  }
  return true;
}

bool SceneExit::turnToColumns(Hindrance met) {
  if (asks_columns_) return false;
  asks_columns_ = true;
  clearColumns();
  addColumns(met);
  return true;
}

FoundWay SceneExit::shortest(const Push& drive) {
  return scratch_.way.shortest(drive, step_.model.options.slide.step);
}

Vec3 SceneExit::floorProbeHere() const { return floorProbe(step_, e_); }

/// Adds the robot's spheres in all groups that are not known to be free: those that are blocked,
/// and those that slices know to be free.
void SceneExit::addBody() {
  for (std::size_t eight = 0; eight * kLanes < step_.model.groups.size(); ++eight) {
    scratch_.suited[eight] |= isBegun() ? addFromBefore(eight) : addFromHere(eight);
  }
}

/// Adds the groups of an eight to a way that begins at their current place. Returns the groups
/// whose spheres were all added, as bits.
unsigned SceneExit::addFromHere(std::size_t eight) {
  const EightPlaces* places = step_.chunk.places(e_, eight);
  const SeenGroups& seen = step_.chunk.seen(eight);
  const AddedGroups added = scratch_.way.add({.rows = step_.model.slices.rows(),
                                              .groups = step_.model.groups.data() + eight * kLanes,
                                              .places = places,
                                              .asked = seen.unsure,
                                              .blocked = seen.blocked});
  for (unsigned left = added.outside; left != 0; left &= left - 1) {
    const auto n = static_cast<std::size_t>(std::countr_zero(left));
    addSingles(eight * kLanes + n, freeOrBlocked(eight, n) & ~places[n].inside);
  }
  return added.whole;
}

/// The same for a way that begins elsewhere, because the candidate has moved since begin().
unsigned SceneExit::addFromBefore(std::size_t eight) {
  unsigned whole = 0;
  for (unsigned left = step_.chunk.seen(eight).unsure; left != 0; left &= left - 1) {
    const auto n = static_cast<std::size_t>(std::countr_zero(left));
    const std::size_t group = eight * kLanes + n;
    const unsigned added = freeOrBlocked(eight, n);
    whole |= static_cast<unsigned>(added == step_.model.groups[group].spheres) << n;
    const EightPlaces before = placesBefore(group);
    scratch_.way.add(step_.model.slices.rows(), before, added & before.inside);
    addSingles(group, added & ~before.inside);
  }
  return whole;
}

/// The spheres of group `n` of an eight, as bits, except for those that only the columns know to be
/// free.
unsigned SceneExit::freeOrBlocked(std::size_t eight, std::size_t n) const {
  const auto blocked = static_cast<unsigned>(step_.chunk.seen(eight).blocked >> (n * kLanes));
  return step_.model.groups[eight * kLanes + n].spheres &
         (step_.chunk.places(e_, eight)[n].free | blocked);
}

/// Adds spheres of a group that are outside the slices where the way out begins.
void SceneExit::addSingles(std::size_t group, unsigned spheres) {
  if (spheres == 0) return;
  const std::uint32_t radius = step_.model.groups[group].radius_index;
  const SphereBatch all = step_.chunk.spheres(e_);
  for (unsigned left = spheres; left != 0; left &= left - 1) {
    const std::size_t n = group * kLanes + static_cast<std::size_t>(std::countr_zero(left));
    addSphere(radius, {all.x[n], all.y[n], all.z[n]});
  }
}

EightPlaces SceneExit::placesBefore(std::size_t group) const {
  const SphereBatch spheres = step_.chunk.spheres(e_);
  std::array<float, kLanes> x;
  std::array<float, kLanes> z;
  for (std::size_t n = 0; n < kLanes; ++n) {
    x[n] = spheres.x[group * kLanes + n] - moved_.x;
    z[n] = spheres.z[group * kLanes + n] - moved_.z;
  }
  EightPlaces places;
  step_.model.slices.findPlaces(env_.clearance_map, group,
                                {.x = x.data(),
                                 .y = spheres.y + group * kLanes,
                                 .z = z.data(),
                                 .asked = 1,
                                 .places = &places});
  return places;
}

/// Calls visit(radius index, center) for each sphere of the held object that counts.
template <class Visit>
void SceneExit::forEachHeld(const Visit& visit) const {
  if (env_.held < 0) return;
  const SphereBatch held = heldSpheres(step_, e_);
  const IgnoredSpheres ignored = step_.state.ignored(step_.first + e_);
  for (const RadiusRange& range : held.ranges) {
    for (std::uint32_t n = range.first; n < range.first + range.count; ++n) {
      if (hasBit(ignored, n)) continue;
      visit(range.radius_index, Vec3{held.x[n], held.y[n], held.z[n]});
    }
  }
}

bool SceneExit::isBlocked(std::uint32_t radius, const Vec3& center) const {
  return scene_.grids()[radius].clearance(center) != Clearance::kFree;
}

bool SceneExit::heldIsBlocked() const {
  bool any = false;
  forEachHeld(
      [&](std::uint32_t radius, const Vec3& center) { any = any || isBlocked(radius, center); });
  return any;
}

/// Like addBody(), for the held object.
void SceneExit::addHeld() {
  forEachHeld([&](std::uint32_t radius, const Vec3& center) {
    if (isBlocked(radius, center) || isKnown(radius, center)) addSphere(radius, center);
  });
}

/// Whether slices know that a sphere, which is not blocked, is free. They do not for a sphere close
/// above a table, and would make it leave the table.
bool SceneExit::isKnown(std::uint32_t radius, const Vec3& center) const {
  const auto around = step_.model.slices.around(env_.clearance_map, radius, center);
  return !around || around->isFree(0, 0);
}

/// `center`: the sphere's current place.
void SceneExit::addSphere(std::uint32_t radius, const Vec3& center) {
  const ColumnGrid& grid = scene_.grids()[radius];
  const Vec3 before{center.x - moved_.x, center.y, center.z - moved_.z};
  const auto around = step_.model.slices.around(env_.clearance_map, radius, before);
  scratch_.way.add(around ? around->cells() : surroundingsOf(grid, before), grid.layout(), before);
}

/// Whether slices know for each cell that one of the robot's spheres is blocked there. True for
/// most searches of columns, which then end without a look at any. Only if the way begins at the
/// current place.
bool SceneExit::isHopelessInSlices(Hindrance met) const {
  if (isBegun() || (met != Hindrance::kScene && met != Hindrance::kRise)) return false;
  CommonCells may_be_free = CommonCells::everywhere();
  for (std::size_t eight = 0; eight * kLanes < step_.model.groups.size(); ++eight) {
    const SeenGroups& seen = step_.chunk.seen(eight);
    const GroupsToAdd groups{.rows = step_.model.slices.rows(),
                             .groups = step_.model.groups.data() + eight * kLanes,
                             .places = step_.chunk.places(e_, eight),
                             .asked = seen.unsure};
    if (!scratch_.way.leaveUnblocked(groups, may_be_free)) return true;
  }
  return false;
}

/// Adds all groups that are not known to be free, and the held object, and asks the columns where
/// slices do not know.
void SceneExit::addColumns(Hindrance met) {
  if (isHopelessInSlices(met)) return scratch_.way.close();
  if (met == Hindrance::kRise) addColumn(0, floorProbeHere());
  for (std::size_t n = 0; n < step_.model.groups.size(); ++n) {
    unsigned& in_columns = scratch_.in_columns[n / kLanes];
    const unsigned bit = 1U << (n % kLanes);
    // Groups that suited a way through slices have to suit this one, too.
    const unsigned wanted = step_.chunk.seen(n / kLanes).unsure | scratch_.suited[n / kLanes];
    if ((wanted & ~in_columns & bit) == 0) continue;
    in_columns |= bit;
    addColumnsOfGroup(n);
    if (scratch_.columns.isHopeless()) return scratch_.way.close();
  }
  if (!holds_columns_) {
    forEachHeld([&](std::uint32_t radius, const Vec3& center) { addColumn(radius, center); });
  }
  holds_columns_ = true;
  scratch_.way.clear(scene_.grids().front().spacing());
  if (!scratch_.columns.addTo(scratch_.way)) scratch_.way.close();
  // These groups need no further check where the way leads.
  std::ranges::copy(scratch_.in_columns, scratch_.suited.begin());
}

void SceneExit::addColumnsOfGroup(std::size_t n) {
  const EightSpheres& group = step_.model.groups[n];
  const SphereBatch spheres = step_.chunk.spheres(e_);
  // If the way begins here, their places are known.
  const bool is_seen = (step_.chunk.seen(n / kLanes).unsure >> (n % kLanes) & 1U) != 0;
  const bool has_places = !isBegun() && is_seen;
  const EightPlaces& places = step_.chunk.places(e_, n / kLanes)[n % kLanes];
  for (unsigned left = group.spheres; left != 0; left &= left - 1) {
    const auto lane = static_cast<std::size_t>(std::countr_zero(left));
    const std::size_t at = n * kLanes + lane;
    const Vec3 center{spheres.x[at], spheres.y[at], spheres.z[at]};
    if (!has_places) {
      addColumn(group.radius_index, center);
    } else if ((places.inside >> lane & 1U) != 0) {
      addColumn(group.radius_index, center, step_.model.slices.around(places, lane));
    } else {
      addColumn(group.radius_index, center, std::nullopt);
    }
  }
}

/// `center`: the sphere's current place.
void SceneExit::addColumn(std::uint32_t radius, const Vec3& center) {
  const Vec3 before{center.x - moved_.x, center.y, center.z - moved_.z};
  addColumn(radius, before, step_.model.slices.around(env_.clearance_map, radius, before));
}

/// `center`: the sphere's place where the way begins. `around`: what slices know of the cells
/// around it.
void SceneExit::addColumn(std::uint32_t radius, const Vec3& center,
                          const std::optional<SurroundingRows>& around) {
  scratch_.columns.add(scene_.grids()[radius], center, around);
}

}  // namespace galactic::simulation
