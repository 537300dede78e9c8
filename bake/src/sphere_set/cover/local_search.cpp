#include "sphere_set/cover/local_search.h"

#include <algorithm>
#include <limits>

namespace galactic::bake::sphere_set {
namespace {

constexpr std::uint64_t kSeed = 7;
constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
/// Maximum number of distances computed per step. If there would be more, only an even sample of
/// the candidates is scored.
constexpr std::size_t kMostScores = 100'000;
/// Four distances cost about as much as one operation of the bookkeeping.
constexpr std::size_t kScoresPerOperation = 4;
constexpr std::uint64_t kOperationsPerIteration = 100;
/// The cost of an iteration includes a scan of this many chosen candidates. More are charged at
/// this rate.
constexpr std::size_t kChosenPerIteration = 128;
constexpr std::size_t kChosenPerOperation = 4;

}  // namespace

LocalSearch::LocalSearch(const FitTask& task, std::span<const Vec3d> points,
                         const CandidatePool& pool)
    : pool_(pool), columns_of_row_(pool.cover.transposed(points.size())), random_(kSeed) {
  for (const Vec3d& p : points) {
    const Vec3 stored = narrow(p);
    point_x_.push_back(stored.x);
    point_y_.push_back(stored.y);
    point_z_.push_back(stored.z);
  }
  balls_.reserve(pool.candidates.size());
  for (const Candidate& c : pool.candidates) {
    const Vec3 center = narrow(c.center);
    const auto reach = static_cast<float>(task.radii[c.radius_index] + task.eps);
    balls_.push_back({center.x, center.y, center.z, reach * reach});
    // Slightly more than 4, to allow for the rounding of the distances.
    squared_width_ = std::max(squared_width_, 4.001F * reach * reach);
  }
}

void LocalSearch::reset(const Selection& cover) {
  const std::size_t rows = point_x_.size();
  operations_ = 0;
  iteration_ = 0;
  chosen_.clear();
  is_chosen_.assign(balls_.size(), 0);
  loss_.assign(balls_.size(), 0);
  moved_.assign(balls_.size(), 0);
  times_.assign(rows, 0);
  mixed_.assign(rows, 0);
  weight_.assign(rows, 1);
  open_.clear();
  open_rank_.assign(rows, kNone);
  for (std::uint32_t row = 0; row < rows; ++row) open(row);
  for (const std::uint32_t candidate : cover) add(candidate);
}

void LocalSearch::open(std::uint32_t row) {
  open_rank_[row] = static_cast<std::uint32_t>(open_.size());
  open_.push_back(row);
}

void LocalSearch::close(std::uint32_t row) {
  const std::uint32_t rank = open_rank_[row];
  open_[rank] = open_.back();
  open_rank_[open_[rank]] = rank;
  open_.pop_back();
  open_rank_[row] = kNone;
}

void LocalSearch::add(std::uint32_t candidate) {
  is_chosen_[candidate] = 1;
  chosen_.push_back(candidate);
  moved_[candidate] = iteration_;
  std::int64_t alone = 0;
  const auto rows = pool_.cover.column(candidate);
  for (const std::uint32_t row : rows) {
    if (times_[row] == 0) {
      close(row);
      alone += weight_[row];
    } else if (times_[row] == 1) {
      loss_[mixed_[row]] -= weight_[row];
    }
    ++times_[row];
    mixed_[row] ^= candidate;
  }
  loss_[candidate] = alone;
  operations_ += rows.size();
}

void LocalSearch::removeAt(std::size_t rank) {
  const std::uint32_t candidate = chosen_[rank];
  chosen_[rank] = chosen_.back();
  chosen_.pop_back();
  is_chosen_[candidate] = 0;
  moved_[candidate] = iteration_;
  const auto rows = pool_.cover.column(candidate);
  for (const std::uint32_t row : rows) {
    --times_[row];
    mixed_[row] ^= candidate;
    if (times_[row] == 0) {
      open(row);
    } else if (times_[row] == 1) {
      loss_[mixed_[row]] += weight_[row];
    }
  }
  loss_[candidate] = 0;
  operations_ += rows.size();
}

std::size_t LocalSearch::cheapest(std::uint32_t tabu) const {
  std::size_t best = 0;
  bool found = false;
  for (std::size_t rank = 0; rank < chosen_.size(); ++rank) {
    const std::uint32_t candidate = chosen_[rank];
    if (candidate == tabu) continue;
    const std::uint32_t other = chosen_[best];
    const bool better = loss_[candidate] != loss_[other] ? loss_[candidate] < loss_[other]
                                                         : moved_[candidate] < moved_[other];
    if (!found || better) best = rank;
    found = true;
  }
  return best;
}

void LocalSearch::gatherAround(std::uint32_t row) {
  gathered_.x.resize(open_.size());
  gathered_.y.resize(open_.size());
  gathered_.z.resize(open_.size());
  gathered_.weight.resize(open_.size());
  std::size_t count = 0;
  for (const std::uint32_t other : open_) {
    const float dx = point_x_[other] - point_x_[row];
    const float dy = point_y_[other] - point_y_[row];
    const float dz = point_z_[other] - point_z_[row];
    gathered_.x[count] = point_x_[other];
    gathered_.y[count] = point_y_[other];
    gathered_.z[count] = point_z_[other];
    gathered_.weight[count] = weight_[other];
    if (dx * dx + dy * dy + dz * dz <= squared_width_) ++count;
  }
  gathered_count_ = count;
}

std::uint32_t LocalSearch::bestForRandomRow() {
  const std::uint32_t row = open_[random_.below(static_cast<std::uint32_t>(open_.size()))];
  gatherAround(row);
  const WeightedPoints points{gathered_.x.data(), gathered_.y.data(), gathered_.z.data(),
                              gathered_.weight.data(), gathered_count_};
  const auto columns = columns_of_row_.column(row);
  const std::size_t work = columns.size() * gathered_count_;
  const std::size_t stride = work / kMostScores + 1;
  const std::size_t start = stride == 1 ? 0 : random_.below(static_cast<std::uint32_t>(stride));
  operations_ += work / stride / kScoresPerOperation + kOperationsPerIteration;
  std::uint32_t best = kNone;
  std::int32_t best_score = -1;
  for (std::size_t at = start; at < columns.size(); at += stride) {
    const std::uint32_t candidate = columns[at];
    if (is_chosen_[candidate] != 0 || moved_[candidate] == iteration_) continue;
    const std::int32_t scored = ball_weight_(points, balls_[candidate]);
    if (scored > best_score || (scored == best_score && moved_[candidate] < moved_[best])) {
      best_score = scored;
      best = candidate;
    }
  }
  return best;
}

Selection LocalSearch::improve(const Selection& cover, std::uint64_t budget) {
  reset(cover);
  Selection smallest = cover;
  std::uint32_t tabu = kNone;
  iteration_ = 1;
  while (operations_ < budget && !chosen_.empty()) {
    while (open_.empty()) {
      smallest = chosen_;
      if (chosen_.size() <= 1) return smallest;
      removeAt(cheapest(kNone));
    }
    // Remove one, so that the candidate added below makes a cover one smaller than the smallest so
    // far. Not needed if no candidate could be added last time.
    if (chosen_.size() > 1 && chosen_.size() + 1 >= smallest.size()) removeAt(cheapest(tabu));
    const std::uint32_t candidate = bestForRandomRow();
    if (candidate != kNone) {
      add(candidate);
      tabu = candidate;
    }
    for (const std::uint32_t row : open_) ++weight_[row];
    const std::size_t beyond = chosen_.size() - std::min(chosen_.size(), kChosenPerIteration);
    operations_ += open_.size() + beyond / kChosenPerOperation;
    ++iteration_;
  }
  return smallest;
}

}  // namespace galactic::bake::sphere_set
