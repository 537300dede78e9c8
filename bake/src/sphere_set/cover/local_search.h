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
/// The search takes a candidate out of a cover. While points are uncovered (open), it removes one
/// candidate, adds one that covers a random open point, and increases the weight of every point
/// that stays open. Whenever no point is open, it has found a smaller cover.
class LocalSearch {
 public:
  /// `points` are the rows of the pool. Keeps references to all three arguments.
  LocalSearch(const FitTask& task, std::span<const Vec3d> points, const CandidatePool& pool);

  /// The smallest cover found from `cover`, which must cover all points, in about `budget`
  /// operations.
  [[nodiscard]] Selection improve(const Selection& cover, std::uint64_t budget);

  /// Number of exchanges in the last search. It is not proportional to the budget, because finding
  /// the cheapest of many spheres also costs operations.
  [[nodiscard]] std::int64_t exchanges() const { return iteration_; }

 private:
  /// Open points, one array per coordinate, for vector instructions.
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
  /// Rank in chosen_ of the candidate whose removal costs the cover least; `tabu` only if there is
  /// no other.
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
  /// Per candidate: the weight of the points that no other chosen candidate covers, and the
  /// iteration of its last move.
  std::vector<std::int64_t> loss_;
  std::vector<std::int64_t> moved_;
  /// Per row: the number of chosen candidates that cover it, and the exclusive or of their indices,
  /// which is the index itself if there is only one.
  std::vector<std::uint32_t> times_;
  std::vector<std::uint32_t> mixed_;
  std::vector<std::int32_t> weight_;
  /// Open rows, and the position of each row in that list.
  std::vector<std::uint32_t> open_;
  std::vector<std::uint32_t> open_rank_;
  OpenPoints gathered_;
  std::size_t gathered_count_ = 0;
  /// Squared upper bound of the distance between two points that one candidate covers.
  float squared_width_ = 0;
  BallWeight ball_weight_ = fastestBallWeight();
  std::vector<float> point_x_;
  std::vector<float> point_y_;
  std::vector<float> point_z_;
  /// Per candidate, the ball in which it covers points.
  std::vector<Ball> balls_;
};

/// Moves the spheres slightly, one after another, to reduce the mean square of the gaps at `points`
/// and of the protrusions. No gap grows beyond the greater of eps and the largest gap before, no
/// sphere protrudes beyond the greater of tau and its protrusion before, and none leaves the near
/// side of the support.
void polish(const FitTask& task, std::span<const Vec3d> points, int sweeps,
            std::vector<Candidate>& spheres);

}  // namespace galactic::bake::sphere_set
