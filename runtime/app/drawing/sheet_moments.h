#pragma once
#include <cstddef>
#include <cstdint>
#include <set>
#include <vector>

#include "drawing/contact_sheet.h"

namespace galactic {

/// The moments of a run that a contact sheet shows: up to kMost, evenly spread from the first state
/// to the last. A run may end long before all its steps are done, so more moments are held on the
/// way, at a stride that grows with the run.
class SheetMoments {
 public:
  /// Most moments of a sheet.
  static constexpr std::size_t kMost = 6;

  /// What is shown of a moment: a cell for each env.
  struct Moment {
    std::uint64_t step = 0;
    std::vector<SheetCell> cells;
  };

  /// Of a run of `steps` steps, all of them multiples of `every` but for the last.
  SheetMoments(std::uint64_t steps, std::uint64_t every);

  /// Whether the state after `step` steps may be one of the moments.
  [[nodiscard]] bool wants(std::uint64_t step) const;
  /// One that is wanted, or the last one; later than all before.
  void add(Moment moment);
  /// How many a run shows that does all its steps.
  [[nodiscard]] std::size_t planned() const { return planned_count_; }
  /// The most that are held at once.
  [[nodiscard]] static constexpr std::size_t mostHeld() { return kMostAtStride + kMost + 1; }
  /// Once, at the end: the last one that was added is among them.
  [[nodiscard]] std::vector<Moment> take();

 private:
  /// How many are held before the stride doubles: afterwards there are still two of them, at least,
  /// from row to row of the sheet.
  static constexpr std::size_t kMostAtStride = 4 * kMost;

  void thinOut();

  /// What a sheet shows of a run that does all its steps.
  std::set<std::uint64_t> planned_;
  std::size_t planned_count_ = 0;
  std::uint64_t stride_;
  /// Ascending steps.
  std::vector<Moment> held_;
};

}  // namespace galactic
