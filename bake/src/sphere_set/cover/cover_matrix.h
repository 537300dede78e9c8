#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "sphere_set/fit_task.h"
#include "sphere_set/solid/point_grid.h"

namespace galactic::bake::sphere_set {

/// A list of row numbers per column, in contiguous memory.
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
  /// The transpose: for each of `rows` rows, the columns that hold it, ascending.
  [[nodiscard]] CoverMatrix transposed(std::size_t rows) const;

 private:
  std::vector<std::size_t> first_{0};
  std::vector<std::uint32_t> rows_;
};

/// Candidate spheres and the points (rows) that each one covers. A sphere covers a point that is at
/// most eps outside it.
struct CandidatePool {
  std::vector<Candidate> candidates;
  CoverMatrix cover;
};

/// Appends to the pool those of `found` that cover any of the points in `grid`.
void appendCovering(const FitTask& task, const PointGrid& grid, std::span<const Candidate> found,
                    CandidatePool& pool);

/// The pool without candidates that another one within `distance` makes redundant: it covers all
/// they cover and more, or the same with less protrusion.
[[nodiscard]] CandidatePool withoutDominated(const FitTask& task, std::span<const Vec3d> points,
                                             const CandidatePool& pool, double distance);

/// Sets the flag in `covered` of each point that a candidate with an index of at least `from`
/// covers.
void markCovered(const CandidatePool& pool, std::size_t from, std::vector<char>& covered);

/// A suitable cell size of point grids for the spheres of the working set.
[[nodiscard]] double gridCell(const FitTask& task);

}  // namespace galactic::bake::sphere_set
