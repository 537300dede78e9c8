#pragma once
#include <cstddef>
#include <cstdint>
#include <set>
#include <vector>

#include "drawing/contact_sheet.h"

namespace galactic {

/// The moments of a run that a contact sheet shows: up to kMost, evenly spread from the first state
/// to the last. A run may end long before all its steps are done, so more moments are kept along
/// the way, at a stride that grows with the run.
class SheetMoments {
 public:
  /// Most moments of a sheet.
  static constexpr std::size_t kMost = 6;

  /// What is shown of a moment: a cell for each env.
  struct Moment {
    std::uint64_t step = 0;
    std::vector<SheetCell> cells;
  };

  /// For a run of `steps` steps; moments are multiples of `every`, except for the last one.
  SheetMoments(std::uint64_t steps, std::uint64_t every);

  /// Whether the state after `step` steps may be one of the moments.
  [[nodiscard]] bool wants(std::uint64_t step) const;
  /// Adds a moment that is wanted, or the last one; must be later than all before.
  void add(Moment moment);
  /// How many moments are shown of a run that does all its steps.
  [[nodiscard]] std::size_t planned() const { return planned_count_; }
  /// Most moments that are held at once.
  [[nodiscard]] static constexpr std::size_t mostHeld() { return kMostAtStride + kMost + 1; }
  /// Call it once, at the end. The moments include the last one that was added.
  [[nodiscard]] std::vector<Moment> take();

 private:
  /// How many moments are held before the stride doubles: afterwards, there are still at least two
  /// for each row of the sheet.
  static constexpr std::size_t kMostAtStride = 4 * kMost;

  void thinOut();

  /// The moments that a sheet shows of a run that does all its steps.
  std::set<std::uint64_t> planned_;
  std::size_t planned_count_ = 0;
  std::uint64_t stride_;
  /// By ascending step.
  std::vector<Moment> held_;
};

}  // namespace galactic
