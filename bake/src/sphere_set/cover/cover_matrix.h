#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "sphere_set/fit_task.h"
#include "sphere_set/solid/point_grid.h"

namespace galactic::bake::sphere_set {

/// Lists of row numbers, one per column, in one piece of memory.
class CoverMatrix {
 public:
  [[nodiscard]] std::size_t columns() const { return first_.size() - 1; }
  [[nodiscard]] std::size_t entries() const { return rows_.size(); }
  [[nodiscard]] std::span<const std::uint32_t> column(std::size_t at) const {
    return {rows_.data() + first_[at], first_[at + 1] - first_[at]};
  }
  void append(std::span<const std::uint32_t> rows) {
    rows_.insert(rows_.end(), rows.begin(), rows.end());
    first_.push_back(rows_.size());
  }
  /// Columns become rows: for each of `rows` rows the columns that hold it, ascending.
  [[nodiscard]] CoverMatrix transposed(std::size_t rows) const;

 private:
  std::vector<std::size_t> first_{0};
  std::vector<std::uint32_t> rows_;
};

/// Points to cover, spheres that may cover them, and which does: a point is covered by a sphere
/// when it is no further than eps outside it.
struct CandidatePool {
  std::vector<Candidate> candidates;
  CoverMatrix cover;
};

/// Appends `found` to the pool, but for those that cover none of the points in `grid`.
void appendCovering(const FitTask& task, const PointGrid& grid, std::span<const Candidate> found,
                    CandidatePool& pool);

/// Drops candidates that a neighbor, within `distance` of them, makes needless: it covers all they
/// cover and more, or the same with less protrusion.
[[nodiscard]] CandidatePool withoutDominated(const FitTask& task, std::span<const Vec3d> points,
                                             const CandidatePool& pool, double distance);

/// For each of `points` points whether a candidate from number `from` on covers it; added to what
/// `covered` says.
void markCovered(const CandidatePool& pool, std::size_t from, std::vector<char>& covered);

/// A cell size for point grids that suits spheres of the working set.
[[nodiscard]] double gridCell(const FitTask& task);

}  // namespace galactic::bake::sphere_set
