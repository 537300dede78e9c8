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

/// What a set gets wrong: what gaps cost, integrated over the surface, and the square of the
/// protrusions, integrated over the spheres.
struct ErrorWeights {
  GapCost gap;
  double protrusion = 1;
};

/// A few spheres cannot keep to a small tau: while gaps are wide they may protrude this much more.
inline constexpr double kLooserTau = 1.6;

/// Sphere sets of a rising count, each with a small error: greedy growth, then exchanges of one
/// chosen sphere for a candidate while that helps (the local search of the k-median problem; one
/// pass over the candidates judges all exchanges, as in Schubert and Rousseeuw, "Fast and Eager
/// k-Medoids Clustering", Information Systems 2021), then small moves off the candidates' lattice.
/// Counts operations, never time, so that results are reproducible.
class ExchangeSearch {
 public:
  /// Candidates are the nodes of `grid` where a sphere protrudes no further than the task's tau, or
  /// kLooserTau of it while gaps are wide. The surface is
  /// known at `points`, spread evenly. Keeps references to the task and the grid.
  ExchangeSearch(const FitTask& task, const DistanceGrid& grid, std::span<const Vec3d> points,
                 const ErrorWeights& weights);
  /// The same for spheres that are given and only settle: there are no candidates.
  ExchangeSearch(const FitTask& task, const DistanceGrid& grid, std::span<const Vec3d> points,
                 const ErrorWeights& weights, std::span<const Candidate> spheres);

  /// Adds a sphere, exchanges and settles; false, and nothing changes, where no candidate makes the
  /// error less.
  bool grow();

  /// Multiplies what protrusions cost.
  void cheapenProtrusion(double factor);

  /// Moves each sphere a little in turn where that makes the error less, `sweeps` times, with steps
  /// that become shorter.
  void settle(int sweeps);

  [[nodiscard]] std::vector<Candidate> spheres() const;
  /// Of the set so far; square meters times what a gap costs.
  [[nodiscard]] double error() const;
  /// The largest gap at any of the points, meters, at least 0.
  [[nodiscard]] double widestGap() const { return std::max(0.0, widest_); }

 private:
  /// A sphere of the set, and what its protrusion costs.
  struct Chosen {
    Candidate sphere;
    double cost = 0;
  };

  /// What a candidate would lessen the sum of costs by.
  struct Offer {
    double gain = 0;
    std::uint32_t candidate = 0;
    /// Rank of the chosen sphere that goes.
    std::uint32_t leaves = 0;
  };
  /// The best way to add a sphere, and to exchange one.
  struct Offers {
    Offer added;
    Offer exchanged;
  };

  /// The points that are nearest to one chosen sphere.
  struct Cell {
    std::size_t first = 0;
    std::size_t count = 0;
    std::size_t first_block = 0;
    /// A ball around them.
    Vec3d middle;
    double radius = 0;
    /// The widest gap that one of them would have without the sphere.
    double widest_next = 0;
    /// What the sum of costs grows by when the sphere goes.
    double loss = 0;
  };

  /// Where a point is in the set: its gap to the nearest sphere and to the next one.
  struct Place {
    std::uint32_t owner = 0;
    double gap = 0;
    double next_gap = 0;
  };

  void findCandidates();
  [[nodiscard]] std::vector<Candidate> candidatesOf(std::uint32_t radius_index) const;
  /// The place pulled inwards until a sphere there protrudes by tau.
  [[nodiscard]] std::optional<Candidate> pulledInwards(const Vec3d& from,
                                                       std::uint32_t radius_index,
                                                       double highest) const;
  /// Brings cells and costs up to date with the chosen spheres.
  void assign();
  [[nodiscard]] Place placeOf(const Vec3d& point) const;
  void fillCell(Cell& cell, const std::vector<std::uint32_t>& members,
                const std::vector<Place>& places);
  /// Adds the block of some members of a cell.
  void addBlock(std::span<const std::uint32_t> members, const std::vector<Place>& places);
  [[nodiscard]] Offers offersOf(std::uint32_t candidate) const;
  [[nodiscard]] std::vector<Offers> offersOf(const std::vector<std::uint32_t>& candidates) const;
  [[nodiscard]] static Offers best(const std::vector<Offers>& offers);
  /// The candidates that are best to add and to exchange.
  [[nodiscard]] static std::vector<std::uint32_t> promising(std::vector<Offers> offers);
  [[nodiscard]] std::vector<std::uint32_t> everyCandidate() const;
  void exchange();
  void settleOne(std::size_t rank, double step);
  /// Of one sphere where it would stand, up to what does not depend on that.
  [[nodiscard]] double costIn(const Cell& cell, const Chosen& chosen) const;
  [[nodiscard]] CostedPoints pointsOf(const Cell& cell) const;
  [[nodiscard]] double protrusionCost(const Vec3d& center, std::uint32_t radius_index) const;

  const FitTask& task_;
  const DistanceGrid& grid_;
  /// Neighbors close in the list.
  std::vector<Vec3d> points_;
  ErrorWeights weights_;
  GapGainOf gain_of_ = fastestGapGain();
  Random random_;

  std::vector<Chosen> candidates_;
  std::vector<Chosen> chosen_;
  /// The candidate to add next.
  std::uint32_t next_added_ = 0;
  std::vector<Cell> cells_;
  /// The points cell by cell, each filled up to whole lanes, and what they cost.
  std::vector<float> x_;
  std::vector<float> y_;
  std::vector<float> z_;
  std::vector<float> nearest_;
  std::vector<float> next_;
  std::vector<PointBlock> blocks_;
  /// Sum of what points and spheres cost.
  double sum_ = 0;
  double widest_ = 0;
  /// Of a sphere while the widest gap is what it is.
  double most_protrusion_ = 0;
};

/// What a gap costs, in double precision.
[[nodiscard]] double costOfGap(const GapCost& cost, double gap);

/// The integral of the squared protrusion over the surface of a sphere, by samples; m^4.
[[nodiscard]] double protrusionIntegral(const DistanceGrid& grid, const Vec3d& center,
                                        double radius);

}  // namespace galactic::bake::sphere_set
