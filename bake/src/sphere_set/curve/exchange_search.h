#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/random.h"
#include "sphere_set/curve/gap_gain.h"
#include "sphere_set/fit_task.h"
#include "sphere_set/solid/distance_grid.h"

namespace galactic::bake::sphere_set {

/// Weights of a set's error: the cost of gaps, integrated over the surface, and the squared
/// protrusions, integrated over the spheres.
struct ErrorWeights {
  GapCost gap;
  double protrusion = 1;
};

/// A few spheres cannot stay within a small tau. While gaps are wide, they may protrude by up to
/// tau times this.
inline constexpr double kLooserTau = 1.6;

/// Finds sphere sets of increasing size, each with a small error: adds a sphere greedily, then
/// exchanges a chosen sphere for a candidate while that helps (the local search for the k-median
/// problem; one pass over the candidates evaluates all exchanges, as in Schubert and Rousseeuw,
/// "Fast and Eager k-Medoids Clustering", Information Systems 2021), then makes small moves off the
/// candidates' lattice. Effort is counted in operations, never in time, so that results are
/// reproducible.
class ExchangeSearch {
 public:
  /// Candidates are the nodes of `grid` where a sphere protrudes by at most the task's tau, or
  /// kLooserTau times tau while gaps are wide. `points` are spread evenly over the surface and
  /// represent it. Keeps references to the task and the grid.
  ExchangeSearch(const FitTask& task, const DistanceGrid& grid, std::span<const Vec3d> points,
                 const ErrorWeights& weights);
  /// The same for given spheres that can only be settled: there are no candidates.
  ExchangeSearch(const FitTask& task, const DistanceGrid& grid, std::span<const Vec3d> points,
                 const ErrorWeights& weights, std::span<const Candidate> spheres);

  /// Adds a sphere, exchanges and settles. Returns false and changes nothing if no candidate
  /// reduces the error.
  bool grow();

  /// Multiplies the cost of protrusions by `factor`.
  void cheapenProtrusion(double factor);

  /// Moves each sphere slightly if that reduces the error, in `sweeps` sweeps with decreasing
  /// steps.
  void settle(int sweeps);

  [[nodiscard]] std::vector<Candidate> spheres() const;
  /// The error of the current set; square meters times the cost of a gap.
  [[nodiscard]] double error() const;
  /// The largest gap at any of the points, meters, at least 0.
  [[nodiscard]] double widestGap() const { return std::max(0.0, widest_); }

 private:
  /// A sphere and the cost of its protrusion.
  struct Chosen {
    Candidate sphere;
    double cost = 0;
  };

  /// The amount by which a candidate would reduce the sum of costs.
  struct Offer {
    double gain = 0;
    std::uint32_t candidate = 0;
    /// Rank of the chosen sphere that the candidate replaces.
    std::uint32_t leaves = 0;
  };
  /// The best offers to add a sphere and to exchange one.
  struct Offers {
    Offer added;
    Offer exchanged;
  };

  /// The points whose nearest chosen sphere is the same.
  struct Cell {
    std::size_t first = 0;
    std::size_t count = 0;
    std::size_t first_block = 0;
    /// A ball around the points.
    Vec3d middle;
    double radius = 0;
    /// The widest gap of any of the points without the sphere.
    double widest_next = 0;
    /// The amount by which removing the sphere increases the sum of costs.
    double loss = 0;
  };

  /// A point's nearest sphere (`owner`), and its gaps to this sphere and to the next nearest.
  struct Place {
    std::uint32_t owner = 0;
    double gap = 0;
    double next_gap = 0;
  };

  void findCandidates();
  [[nodiscard]] std::vector<Candidate> candidatesOf(std::uint32_t radius_index) const;
  /// The candidate at `from`, pulled inward until its center is no more than `highest` outside the
  /// surface.
  [[nodiscard]] std::optional<Candidate> pulledInwards(const Vec3d& from,
                                                       std::uint32_t radius_index,
                                                       double highest) const;
  /// Updates cells and costs for the chosen spheres.
  void assign();
  [[nodiscard]] Place placeOf(const Vec3d& point) const;
  void fillCell(Cell& cell, const std::vector<std::uint32_t>& members,
                const std::vector<Place>& places);
  /// Adds the block of some members of a cell.
  void addBlock(std::span<const std::uint32_t> members, const std::vector<Place>& places);
  [[nodiscard]] Offers offersOf(std::uint32_t candidate) const;
  [[nodiscard]] std::vector<Offers> offersOf(const std::vector<std::uint32_t>& candidates) const;
  [[nodiscard]] static Offers best(const std::vector<Offers>& offers);
  /// The candidates that are best to add or to exchange.
  [[nodiscard]] static std::vector<std::uint32_t> promising(std::vector<Offers> offers);
  [[nodiscard]] std::vector<std::uint32_t> everyCandidate() const;
  void exchange();
  void settleOne(std::size_t rank, double step);
  /// The cost of one sphere at its position, up to a term that does not depend on the position.
  [[nodiscard]] double costIn(const Cell& cell, const Chosen& chosen) const;
  [[nodiscard]] CostedPoints pointsOf(const Cell& cell) const;
  [[nodiscard]] double protrusionCost(const Vec3d& center, std::uint32_t radius_index) const;

  const FitTask& task_;
  const DistanceGrid& grid_;
  /// Sorted so that neighbors in space are close to each other in the list.
  std::vector<Vec3d> points_;
  ErrorWeights weights_;
  GapGainOf gain_of_ = fastestGapGain();
  Random random_;

  std::vector<Chosen> candidates_;
  std::vector<Chosen> chosen_;
  /// The candidate to add next.
  std::uint32_t next_added_ = 0;
  std::vector<Cell> cells_;
  /// The points and their costs, cell by cell, each padded to a multiple of kGainLanes.
  std::vector<float> x_;
  std::vector<float> y_;
  std::vector<float> z_;
  std::vector<float> nearest_;
  std::vector<float> next_;
  std::vector<PointBlock> blocks_;
  /// Sum of the costs of points and spheres.
  double sum_ = 0;
  double widest_ = 0;
  /// How far a sphere may protrude given the current widest gap.
  double most_protrusion_ = 0;
};

/// The cost of a gap, in double precision.
[[nodiscard]] double costOfGap(const GapCost& cost, double gap);

/// The integral of the squared protrusion over the surface of a sphere, estimated by samples; m^4.
[[nodiscard]] double protrusionIntegral(const DistanceGrid& grid, const Vec3d& center,
                                        double radius);

}  // namespace galactic::bake::sphere_set
