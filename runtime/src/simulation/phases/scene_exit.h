#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "simulation/collision/collision.h"
#include "simulation/phases/chunk.h"
#include "simulation/phases/contacts.h"
#include "simulation/ways_out/free_slices.h"
#include "simulation/ways_out/way_out.h"

namespace galactic::simulation {

/// Finds the shortest move of one candidate out of the scene. Gathers the spheres of the robot, or
/// of the held object, that decide where it leads. Uses what the slices know of the cells around
/// the spheres and, if these know no way out, the columns themselves. All ways begin where the
/// candidate was at the last begin(). If it has moved since then, spheres that are blocked at its
/// new place join those that were added before.
class SceneExit {
 public:
  SceneExit(const ChunkStep& step, std::size_t e);

  /// Forgets all spheres and lets ways begin at the candidate's current place.
  void begin();

  /// Call when the candidate has been moved to `moved`, counted from where ways begin. Unless it
  /// kept its height (`is_level`), forgets what is known of the groups.
  void follow(const Push& moved, bool is_level);

  /// How far the candidate is from where ways begin.
  [[nodiscard]] const Push& moved() const { return moved_; }

  /// Adds the deciding spheres at the candidate's current place, where it meets `met`. Returns
  /// whether the scene blocks any.
  bool addBlocked(Hindrance met);

  /// Switches to asking columns, because slices know no way. Returns false if that was done before.
  bool turnToColumns(Hindrance met);

  /// The shortest move from where ways begin, no longer than a slide may be, that does not push the
  /// robot further along `drive`.
  [[nodiscard]] FoundWay shortest(const Push& drive);

  /// Whether any place around is free for all spheres.
  [[nodiscard]] bool isOpen() const { return scratch_.way.isOpen(); }

  /// The groups known to be free where the last way leads, as bits, eight by eight.
  [[nodiscard]] std::span<const unsigned> suited() const { return scratch_.suited; }

  /// Whether the scene blocks the held object.
  [[nodiscard]] bool heldIsBlocked() const;

 private:
  void forgetGroups();
  void clearColumns();
  [[nodiscard]] bool isBegun() const { return moved_.x != 0 || moved_.z != 0; }
  [[nodiscard]] Vec3 floorProbeHere() const;
  void addBody();
  unsigned addFromHere(std::size_t eight);
  unsigned addFromBefore(std::size_t eight);
  [[nodiscard]] unsigned freeOrBlocked(std::size_t eight, std::size_t n) const;
  void addSingles(std::size_t group, unsigned spheres);
  [[nodiscard]] EightPlaces placesBefore(std::size_t group) const;
  template <class Visit>
  void forEachHeld(const Visit& visit) const;
  [[nodiscard]] bool isBlocked(std::uint32_t radius, const Vec3& center) const;
  void addHeld();
  [[nodiscard]] bool isKnown(std::uint32_t radius, const Vec3& center) const;
  void addSphere(std::uint32_t radius, const Vec3& center);
  [[nodiscard]] bool isHopelessInSlices(Hindrance met) const;
  void addColumns(Hindrance met);
  void addColumnsOfGroup(std::size_t n);
  void addColumn(std::uint32_t radius, const Vec3& center);
  void addColumn(std::uint32_t radius, const Vec3& center,
                 const std::optional<SurroundingRows>& around);

  const ChunkStep& step_;
  std::size_t e_;
  const Env& env_;
  const Scene& scene_;
  SceneExitScratch& scratch_;
  Push moved_;
  bool asks_columns_ = false;
  /// Whether the held object was added to the columns.
  bool holds_columns_ = false;
};

}  // namespace galactic::simulation
