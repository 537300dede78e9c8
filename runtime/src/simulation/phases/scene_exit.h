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

/// Seeks the shortest move of one candidate out of the scene: gathers the spheres that decide where
/// it leads, of the robot or of what it holds, at first with what slices know of the cells around
/// them, and once these know no way out, with what the columns do.
///
/// All ways begin where begin() was called last. Where the candidate has been moved since, spheres
/// that are found to be blocked there join those that were added before.
class SceneExit {
 public:
  SceneExit(const ChunkStep& step, std::size_t e);

  /// Forgets all spheres; ways begin where the candidate is now.
  void begin();

  /// The candidate was moved to `moved` from where ways begin. At another height than before
  /// (`is_level`), nothing is known of any group.
  void follow(const Push& moved, bool is_level);

  /// How far the candidate is from where ways begin.
  [[nodiscard]] const Push& moved() const { return moved_; }

  /// Adds the spheres that decide, where the candidate is now and meets `met`. Whether the scene
  /// blocks any.
  bool addBlocked(Hindrance met);

  /// Asks columns from now on, for want of a way that slices know. False if that was done before.
  bool turnToColumns(Hindrance met);

  /// The shortest move from where ways begin, no longer than a slide may be, and not on along
  /// `drive`.
  [[nodiscard]] FoundWay shortest(const Push& drive);

  /// Whether there is any place around that is free for all spheres.
  [[nodiscard]] bool isOpen() const { return scratch_.way.isOpen(); }

  /// Groups that are free where the last way leads, as bits, eight by eight.
  [[nodiscard]] std::span<const unsigned> suited() const { return scratch_.suited; }

  /// Whether the scene blocks what the robot holds.
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
  /// What the robot holds is in the columns.
  bool holds_columns_ = false;
};

}  // namespace galactic::simulation
