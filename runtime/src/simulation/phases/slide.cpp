#include "simulation/phases/slide.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>

#include "simulation/phases/contacts.h"
#include "simulation/phases/move.h"

namespace galactic::simulation {
namespace {

/// Moves the candidate over the floor. Whether it is as high as before.
bool moveBase(const ChunkStep& step, std::size_t e, const Push& by) {
  const float floor_before = *step.state.poses(step.first + e).y;
  const Vec3 base = step.chunk.base(e);
  const FloorUnder under = floorUnder(step, e, {base.x + by.x, floor_before, base.z + by.z});
  step.chunk.floor(e) = under.floor;
  step.chunk.shift(e, {by.x, under.height - base.y, by.z});
  return under.height == base.y;
}

/// Slides one candidate along what blocks it: the shortest move out of the scene, then out of
/// objects, and so on until it is free.
class Glide {
 public:
  Glide(const ChunkStep& step, std::size_t e)
      : step_(step),
        e_(e),
        env_(step.state.env(step.first + e)),
        obstacles_(obstaclesOf(step, e)),
        way_(step.chunk.wayOut()) {
    const Vec3 from = step.state.base(step.first + e);
    const Vec3 to = step.chunk.base(e);
    drive_ = {to.x - from.x, to.z - from.z};
    begin();
  }

  /// isFree() has said that the candidate is not. Whether it is now.
  bool run() {
    for (std::uint32_t attempt = 0; attempt < step_.model.options.slide.attempts; ++attempt) {
      if (step_.chunk.floor(e_) == Floor::kDrops) return false;
      if (!(addBlocked() ? leaveScene() : leaveObjects())) return false;
      if (isFreeNow()) return true;
    }
    return false;
  }

 private:
  /// Moves the candidate over the floor. Whether it is as high as before.
  bool move(const Push& by) {
    const bool is_level = moveBase(step_, e_, by);
    since_asked_ = {since_asked_.x + by.x, since_asked_.z + by.z};
    knows_maps_ = knows_maps_ && is_level;
    return is_level;
  }

  bool isFreeNow() {
    if (step_.chunk.floor(e_) != Floor::kCarries) return false;
    // With something in the hand, another way out may be sought for the groups that are asked here.
    if (env_.held < 0 && knows_maps_ && isSureAfter(step_, e_, since_asked_)) {
      if (isFreeOfObjects(step_, e_)) return true;
      std::ranges::fill(step_.chunk.blockedBits(), 0U);
      return false;
    }
    knows_maps_ = false;
    return !findBlocked(step_, e_) && isFreeOfObjects(step_, e_);
  }

  /// The way out is sought from where the candidate is now.
  void begin() {
    way_.clear(obstacles_.scene.grids().front().spacing());
    forgetWays();
    moved_ = {};
    has_way_ = true;
  }

  /// No group is known to suit a way, nor to be in columns.
  void forgetWays() {
    step_.chunk.columnWays().clear();
    step_.chunk.forgetWays();
    holds_columns_ = false;
  }

  /// Adds the spheres that decide where the way out of the scene leads. Whether the scene blocks
  /// any.
  bool addBlocked() {
    const bool floor_blocks = step_.chunk.floor(e_) == Floor::kBlocks;
    if (floor_blocks) {
      knows_maps_ = false;
      findBlocked(step_, e_);
    }
    const bool body = floor_blocks || !isEmpty(step_.chunk.blockedBits());
    // isFree() asks about what the robot holds when the robot itself is free.
    const bool held = !body && !isEmpty(step_.chunk.heldBits()) && heldIsBlocked();
    if (!body && !held) return false;
    if (asks_columns_) {
      addColumns();
      return true;
    }
    if (floor_blocks) addSphere(0, floorProbeHere());
    if (body) {
      addBody();
    } else {
      addHeld();
    }
    return true;
  }

  [[nodiscard]] Vec3 floorProbeHere() const {
    return floorProbe(obstacles_.scene, step_.chunk.base(e_), step_.model.options.ground);
  }

  /// Adds the robot's spheres in all groups that are not free as a whole: those that are blocked,
  /// and those of which it is known where they are free.
  void addBody() {
    const bool is_begun = moved_.x != 0 || moved_.z != 0;
    for (std::size_t eight = 0; eight * kLanes < step_.model.groups.size(); ++eight) {
      GroupBits& known = step_.chunk.groupBits(eight);
      // Of those that are low, nobody has looked.
      if ((known.unsure & known.low) != 0) findPlaces(step_, e_, eight, known.unsure & known.low);
      known.suited |= is_begun ? addFromBefore(eight) : addFromHere(eight);
    }
  }

  /// Adds the groups of an eight; the way out begins where they are. Those whose spheres were all
  /// added, as bits.
  unsigned addFromHere(std::size_t eight) {
    const EightPlaces* places = step_.chunk.places(e_, eight);
    const AddedGroups added = way_.add({.rows = step_.model.slices.rows(),
                                        .groups = step_.model.groups.data() + eight * kLanes,
                                        .places = places,
                                        .asked = step_.chunk.groupBits(eight).unsure,
                                        .blocked = step_.chunk.blockedBits()[eight]});
    for (unsigned left = added.outside; left != 0; left &= left - 1) {
      const auto n = static_cast<std::size_t>(std::countr_zero(left));
      addSingles(eight * kLanes + n, freeOrBlocked(eight, n) & ~places[n].inside);
    }
    return added.whole;
  }

  /// The same where the way out was begun before.
  unsigned addFromBefore(std::size_t eight) {
    unsigned whole = 0;
    for (unsigned left = step_.chunk.groupBits(eight).unsure; left != 0; left &= left - 1) {
      const auto n = static_cast<std::size_t>(std::countr_zero(left));
      const std::size_t group = eight * kLanes + n;
      const unsigned added = freeOrBlocked(eight, n);
      whole |= static_cast<unsigned>(added == step_.model.groups[group].spheres) << n;
      const EightPlaces before = placesBefore(group);
      way_.add(step_.model.slices.rows(), before, added & before.inside);
      addSingles(group, added & ~before.inside);
    }
    return whole;
  }

  /// The spheres of group `n` of an eight, as bits, but for those that only columns call free.
  [[nodiscard]] unsigned freeOrBlocked(std::size_t eight, std::size_t n) const {
    const auto blocked = static_cast<unsigned>(step_.chunk.blockedBits()[eight] >> (n * kLanes));
    return step_.model.groups[eight * kLanes + n].spheres &
           (step_.chunk.places(e_, eight)[n].free | blocked);
  }

  /// Adds spheres of a group of which slices know nothing where the way out begins.
  void addSingles(std::size_t group, unsigned spheres) {
    if (spheres == 0) return;
    const std::uint32_t radius = step_.model.groups[group].radius_index;
    const SphereBatch all = step_.chunk.spheres(e_);
    for (unsigned left = spheres; left != 0; left &= left - 1) {
      const std::size_t n = group * kLanes + static_cast<std::size_t>(std::countr_zero(left));
      addSphere(radius, {all.x[n], all.y[n], all.z[n]});
    }
  }

  [[nodiscard]] EightPlaces placesBefore(std::size_t group) const {
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

  /// Calls visit(radius index, center) for each sphere of what the robot holds that counts.
  template <class Visit>
  void forEachHeld(const Visit& visit) const {
    if (env_.held < 0) return;
    const SphereBatch held = heldSpheres(step_, e_);
    const IgnoredSpheres ignored = step_.state.ignored(step_.first + e_);
    for (const RadiusRange& range : held.ranges) {
      for (std::uint32_t n = range.first; n < range.first + range.count; ++n) {
        if ((ignored[n / 64] >> (n % 64) & 1U) != 0) continue;
        visit(range.radius_index, Vec3{held.x[n], held.y[n], held.z[n]});
      }
    }
  }

  [[nodiscard]] bool isBlocked(std::uint32_t radius, const Vec3& center) const {
    return obstacles_.scene.grids()[radius].clearance(center) != Clearance::kFree;
  }

  [[nodiscard]] bool heldIsBlocked() const {
    bool any = false;
    forEachHeld(
        [&](std::uint32_t radius, const Vec3& center) { any = any || isBlocked(radius, center); });
    return any;
  }

  /// As addBody() for what the robot holds.
  void addHeld() {
    forEachHeld([&](std::uint32_t radius, const Vec3& center) {
      if (isBlocked(radius, center) || isKnown(radius, center)) addSphere(radius, center);
    });
  }

  /// Whether slices say rightly that a sphere is free where it is. Close above a table they do not,
  /// and would have it leave the table.
  [[nodiscard]] bool isKnown(std::uint32_t radius, const Vec3& center) const {
    const auto around = step_.model.slices.around(env_.clearance_map, radius, center);
    return !around || around->isFree(0, 0);
  }

  /// `center`: where the sphere is now.
  void addSphere(std::uint32_t radius, const Vec3& center) {
    const ColumnGrid& grid = obstacles_.scene.grids()[radius];
    const Vec3 before{center.x - moved_.x, center.y, center.z - moved_.z};
    const auto around = step_.model.slices.around(env_.clearance_map, radius, before);
    way_.add(around ? around->cells() : surroundingsOf(grid, before), grid.layout(), before);
  }

  /// Whether slices call each cell blocked for one of the robot's spheres that isFree() has just
  /// looked at: most searches of columns end here.
  [[nodiscard]] bool isHopelessInSlices() const {
    const bool is_begun = moved_.x != 0 || moved_.z != 0;
    // Where nothing blocks the robot nobody may have looked.
    if (is_begun || isEmpty(step_.chunk.blockedBits())) return false;
    CommonCells may_be_free = CommonCells::everywhere();
    for (std::size_t eight = 0; eight * kLanes < step_.model.groups.size(); ++eight) {
      const GroupBits& known = step_.chunk.groupBits(eight);
      const GroupsToAdd groups{.rows = step_.model.slices.rows(),
                               .groups = step_.model.groups.data() + eight * kLanes,
                               .places = step_.chunk.places(e_, eight),
                               .asked = known.unsure & ~known.low};
      if (!way_.leaveUnblocked(groups, may_be_free)) return true;
    }
    return false;
  }

  /// Adds all spheres that are not free as a whole, and what the robot holds, and asks the columns
  /// where the slices do not know better.
  void addColumns() {
    if (isHopelessInSlices()) {
      has_way_ = false;
      return;
    }
    ColumnWays& columns = step_.chunk.columnWays();
    if (step_.chunk.floor(e_) == Floor::kBlocks) addColumn(0, floorProbeHere());
    const SphereBatch spheres = step_.chunk.spheres(e_);
    const bool is_begun = moved_.x != 0 || moved_.z != 0;
    for (std::size_t n = 0; n < step_.model.groups.size(); ++n) {
      GroupBits& known = step_.chunk.groupBits(n / kLanes);
      const unsigned bit = 1U << (n % kLanes);
      const EightSpheres& group = step_.model.groups[n];
      // Those that suited a way through slices have to suit this one, too.
      if (((known.unsure | known.suited) & ~known.in_columns & bit) == 0) continue;
      known.in_columns |= bit;
      // Where the way begins here, it is known where they are.
      const bool has_places = !is_begun && (known.unsure & bit) != 0;
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
      if (columns.isHopeless()) {
        has_way_ = false;
        return;
      }
    }
    if (!holds_columns_) {
      forEachHeld([&](std::uint32_t radius, const Vec3& center) { addColumn(radius, center); });
    }
    holds_columns_ = true;
    way_.clear(obstacles_.scene.grids().front().spacing());
    has_way_ = columns.addTo(way_);
    // No group needs another look where they lead.
    step_.chunk.suitColumnsOnly();
  }

  /// `center`: where the sphere is now.
  void addColumn(std::uint32_t radius, const Vec3& center) {
    const Vec3 before{center.x - moved_.x, center.y, center.z - moved_.z};
    addColumn(radius, before, step_.model.slices.around(env_.clearance_map, radius, before));
  }
  /// `center`: where the way begins. `around`: what slices know.
  void addColumn(std::uint32_t radius, const Vec3& center,
                 const std::optional<SurroundingRows>& around) {
    step_.chunk.columnWays().add(obstacles_.scene.grids()[radius], center, around);
  }

  [[nodiscard]] FoundWay findWay(const Push& drive) {
    if (!has_way_) return {};
    return way_.shortest(drive, step_.model.options.slide.step);
  }

  bool leaveScene() {
    FoundWay way = findWay(drive_);
    if (way.squared == kNoWay && !asks_columns_) {
      asks_columns_ = true;
      addColumns();
      way = findWay(drive_);
    }
    // Where the arm or a turn led into something, the drive is not to blame.
    if (way.squared == kNoWay && has_way_ && isBlockedWithoutDrive()) way = findWay({});
    if (way.squared == kNoWay) return false;
    const bool is_level = move({way.x - moved_.x, way.z - moved_.z});
    // At another height all is different.
    if (!is_level) forgetWays();
    moved_ = {way.x, way.z};
    return true;
  }

  /// Whether the scene would block the robot, or what it holds, if it had not driven.
  [[nodiscard]] bool isBlockedWithoutDrive() {
    if (drive_.x == 0 && drive_.z == 0) return false;
    const Push back{-drive_.x - moved_.x, -drive_.z - moved_.z};
    step_.chunk.shift(e_, {back.x, 0, back.z});
    step_.chunk.forgetSuited();
    knows_maps_ = false;
    const bool is_blocked = findBlocked(step_, e_) || heldIsBlocked();
    step_.chunk.shift(e_, {-back.x, 0, -back.z});
    return is_blocked;
  }

  bool leaveObjects() {
    PushSum sum;
    CollisionScratch& scratch = step_.chunk.collision();
    if (obstacles_.objects.mayTouch(step_.chunk.extents(e_))) {
      withoutLeft(step_, e_, [&] {
        return pushOutOfObjects(obstacles_.objects, step_.chunk.spheres(e_), {}, scratch, sum);
      });
    }
    if (env_.held >= 0 && !heldIsSurelyFree(step_, e_)) {
      pushOutOfObjects(obstacles_.objects, heldSpheres(step_, e_),
                       step_.state.ignored(step_.first + e_), scratch, sum);
    }
    const Push push = sum.total(step_.model.options.slide.step);
    if (push.x == 0 && push.z == 0) return false;
    move(push);
    begin();
    return true;
  }

  const ChunkStep& step_;
  std::size_t e_;
  const Env& env_;
  Obstacles obstacles_;
  WayOut& way_;
  Push drive_;
  /// From where the way out was begun.
  Push moved_;
  /// From where the maps were asked what is sure.
  Push since_asked_;
  /// What they said is of where the candidate was, at the same height.
  bool knows_maps_ = true;
  bool has_way_ = true;
  /// Slices know no way out, so columns are asked from now on.
  bool asks_columns_ = false;
  /// What the robot holds has been asked about.
  bool holds_columns_ = false;
};

/// The jitter of the published rule away from a sphere: towards the base.
Push pushFrom(const ChunkStep& step, std::size_t e, const SphereBatch& spheres,
              std::uint32_t sphere) {
  const Vec3 base = step.chunk.base(e);
  const float x = base.x - spheres.x[sphere];
  const float z = base.z - spheres.z[sphere];
  const float length = std::sqrt(x * x + z * z);
  constexpr float kNoDirection = 1e-3F;
  if (!(length > kNoDirection)) return {};
  const float scale = step.model.options.slide.step / length;
  return {x * scale, z * scale};
}

/// The published rule asks about one thing after the other, and the first sphere in contact
/// decides: the robot in the scene, what it holds in the scene, then both among the objects. In the
/// scene, attempts take turns to begin with the robot's last sphere and with its first.
class TowardsBase {
 public:
  TowardsBase(const ChunkStep& step, std::size_t e, std::uint32_t attempt)
      : step_(step), e_(e), from_last_(attempt % 2 == 0), obstacles_(obstaclesOf(step, e)) {}

  [[nodiscard]] Push push() const {
    const SphereBatch body = step_.chunk.spheres(e_);
    const std::span<std::uint64_t> body_bits = step_.chunk.bodyBits();
    const bool holds = step_.state.env(step_.first + e_).held >= 0;
    const SphereBatch held = holds ? heldSpheres(step_, e_) : SphereBatch{};
    if (penetratingScene(obstacles_.scene, body, step_.chunk.collision(), body_bits)) {
      return pushFrom(step_, e_, body, firstOfBody(from_last_));
    }
    if (holds) {
      penetratingScene(obstacles_.scene, held, step_.chunk.collision(), step_.chunk.heldBits());
      if (const auto sphere = firstHeld()) return pushFrom(step_, e_, held, *sphere);
    }
    const bool touches = withoutLeft(
        step_, e_, [&] { return penetratingObjects(obstacles_.objects, body, body_bits); });
    if (touches) return pushFrom(step_, e_, body, firstOfBody(false));
    if (!holds) return {};
    penetratingObjects(obstacles_.objects, held, step_.chunk.heldBits());
    const auto sphere = firstHeld();
    return sphere ? pushFrom(step_, e_, held, *sphere) : Push{};
  }

 private:
  /// Of those whose bit is set, one of which there is.
  [[nodiscard]] std::uint32_t firstOfBody(bool from_last) const {
    const std::span<const std::uint32_t> order = step_.model.motion.spheres_by_link;
    const std::span<const std::uint64_t> bits = step_.chunk.bodyBits();
    const auto is_set = [&](std::uint32_t n) { return (bits[n / 64] >> (n % 64) & 1U) != 0; };
    return from_last ? *std::find_if(order.rbegin(), order.rend(), is_set)
                     : *std::find_if(order.begin(), order.end(), is_set);
  }

  [[nodiscard]] std::optional<std::uint32_t> firstHeld() const {
    const IgnoredSpheres ignored = step_.state.ignored(step_.first + e_);
    const std::span<const std::uint64_t> bits = step_.chunk.heldBits();
    for (std::size_t w = 0; w < bits.size(); ++w) {
      const std::uint64_t word = bits[w] & ~ignored[w];
      if (word != 0)
        return static_cast<std::uint32_t>(64 * w) +
               static_cast<std::uint32_t>(std::countr_zero(word));
    }
    return std::nullopt;
  }

  const ChunkStep& step_;
  std::size_t e_;
  bool from_last_;
  Obstacles obstacles_;
};

bool pushTowardsBase(const ChunkStep& step, std::size_t e) {
  for (std::uint32_t attempt = 0; attempt < step.model.options.slide.attempts; ++attempt) {
    if (step.chunk.floor(e) == Floor::kDrops) return false;
    const Push push = TowardsBase(step, e, attempt).push();
    if (push.x == 0 && push.z == 0) return false;
    moveBase(step, e, push);
    if (isFree(step, e)) return true;
  }
  return false;
}

}  // namespace

bool slideClear(const ChunkStep& step, std::size_t e) noexcept {
  switch (step.model.options.slide.direction) {
    case SlideDirection::kGlide:
      return Glide(step, e).run();
    case SlideDirection::kTowardsBase:
      return pushTowardsBase(step, e);
  }
  return false;
}

}  // namespace galactic::simulation
