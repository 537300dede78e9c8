#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "common/random.h"
#include "sphere_set/cover/ball_weight.h"
#include "sphere_set/cover/set_cover.h"
#include "sphere_set/fit_task.h"

namespace galactic::bake::sphere_set {

/// Row weighting local search for the smallest cover (Gao, Weise and Li, "An Efficient Local Search
/// Heuristic with Row Weighting for the Unicost Set Covering Problem", EJOR 2015).
///
/// A candidate is taken out of a cover; while points are open, one candidate goes out, one that
/// covers a random open point comes in, and every point that stays open gains weight. Each time
/// that nothing is open, a smaller cover has been found.
class LocalSearch {
 public:
  /// `points` are the rows of the pool; the search keeps references to all three.
  LocalSearch(const FitTask& task, std::span<const Vec3d> points, const CandidatePool& pool);

  /// The smallest cover found from `cover`, which must cover all points, in about `budget`
  /// operations.
  [[nodiscard]] Selection improve(const Selection& cover, std::uint64_t budget);

  /// How many exchanges the last search took: looking for the cheapest of many spheres costs, too.
  [[nodiscard]] std::int64_t exchanges() const { return iteration_; }

 private:
  /// Open points side by side, for the vector unit.
  struct OpenPoints {
    std::vector<float> x;
    std::vector<float> y;
    std::vector<float> z;
    std::vector<std::int32_t> weight;
  };

  void reset(const Selection& cover);
  void add(std::uint32_t candidate);
  void removeAt(std::size_t rank);
  void open(std::uint32_t row);
  void close(std::uint32_t row);
  /// Rank in chosen_ of the candidate that the cover loses least by; `tabu` only if nothing else.
  [[nodiscard]] std::size_t cheapest(std::uint32_t tabu) const;
  /// The best candidate that covers a random open point.
  [[nodiscard]] std::uint32_t bestForRandomRow();
  /// Gathers the open points that a candidate covering `row` may cover.
  void gatherAround(std::uint32_t row);

  const CandidatePool& pool_;
  CoverMatrix columns_of_row_;
  Random random_;
  std::uint64_t operations_ = 0;
  std::int64_t iteration_ = 0;

  std::vector<std::uint32_t> chosen_;
  std::vector<char> is_chosen_;
  /// Per candidate: weight of the points that only it covers, and the iteration of its last move.
  std::vector<std::int64_t> loss_;
  std::vector<std::int64_t> moved_;
  /// Per row: how many chosen candidates cover it, and the exclusive or of their numbers, which is
  /// the number itself where there is one.
  std::vector<std::uint32_t> times_;
  std::vector<std::uint32_t> mixed_;
  std::vector<std::int32_t> weight_;
  /// Open rows, and where each is in the list.
  std::vector<std::uint32_t> open_;
  std::vector<std::uint32_t> open_rank_;
  OpenPoints gathered_;
  std::size_t gathered_count_ = 0;
  /// No two points that one candidate covers are further apart than the root of this.
  float squared_width_ = 0;
  BallWeight ball_weight_ = fastestBallWeight();
  std::vector<float> point_x_;
  std::vector<float> point_y_;
  std::vector<float> point_z_;
  /// Per candidate.
  std::vector<Ball> balls_;
};

/// Moves the spheres a little, each in turn, so that the mean square of the gaps at `points` and of
/// the protrusions falls. No gap grows beyond eps, or beyond the largest that there was; no sphere
/// protrudes beyond tau, or beyond what it did; none leaves the near side of the support.
void polish(const FitTask& task, std::span<const Vec3d> points, int sweeps,
            std::vector<Candidate>& spheres);

}  // namespace galactic::bake::sphere_set
