#include "sphere_set/local_search.h"

#include <limits>

namespace galactic::bake::sphere_fit {
namespace {

constexpr std::uint64_t kSeed = 7;
constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
/// Distances computed in one step; of more only an even share of the candidates is scored.
constexpr std::size_t kMostScores = 100'000;
/// Four distances cost about what one step of the bookkeeping costs.
constexpr std::size_t kScoresPerOperation = 4;
constexpr std::uint64_t kOperationsPerIteration = 100;

}  // namespace

LocalSearch::LocalSearch(const FitTask& task, std::span<const Vec3d> points,
                         const CandidatePool& pool)
    : pool_(pool), columns_of_row_(pool.cover.transposed(points.size())), random_(kSeed) {
  for (const Vec3d& p : points) {
    const Vec3 stored = toVec3(p);
    point_x_.push_back(stored.x);
    point_y_.push_back(stored.y);
    point_z_.push_back(stored.z);
  }
  balls_.reserve(pool.candidates.size());
  for (const Candidate& c : pool.candidates) {
    const Vec3 centre = toVec3(c.centre);
    const auto reach = static_cast<float>(task.radii[c.radius_index] + task.eps);
    balls_.push_back({centre.x, centre.y, centre.z, reach * reach});
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

void LocalSearch::gatherOpen() {
  const std::size_t count = open_.size();
  gathered_.x.resize(count);
  gathered_.y.resize(count);
  gathered_.z.resize(count);
  gathered_.weight.resize(count);
  for (std::size_t at = 0; at < count; ++at) {
    gathered_.x[at] = point_x_[open_[at]];
    gathered_.y[at] = point_y_[open_[at]];
    gathered_.z[at] = point_z_[open_[at]];
    gathered_.weight[at] = weight_[open_[at]];
  }
}

std::int32_t LocalSearch::score(std::uint32_t candidate) const {
  const Ball ball = balls_[candidate];
  const float* x = gathered_.x.data();
  const float* y = gathered_.y.data();
  const float* z = gathered_.z.data();
  const std::int32_t* weight = gathered_.weight.data();
  const std::size_t count = open_.size();
  // Whole numbers add up the same in any order, so the compiler may use the vector unit.
  std::int32_t sum = 0;
  for (std::size_t at = 0; at < count; ++at) {
    const float dx = x[at] - ball.x;
    const float dy = y[at] - ball.y;
    const float dz = z[at] - ball.z;
    const float squared = dx * dx + dy * dy + dz * dz;
    sum += squared <= ball.squared_reach ? weight[at] : 0;
  }
  return sum;
}

std::uint32_t LocalSearch::bestForRandomRow() {
  gatherOpen();
  const std::uint32_t row = open_[random_.below(static_cast<std::uint32_t>(open_.size()))];
  const auto columns = columns_of_row_.column(row);
  const std::size_t work = columns.size() * open_.size();
  const std::size_t stride = work / kMostScores + 1;
  const std::size_t start = stride == 1 ? 0 : random_.below(static_cast<std::uint32_t>(stride));
  operations_ += work / stride / kScoresPerOperation + kOperationsPerIteration;
  std::uint32_t best = kNone;
  std::int32_t best_score = -1;
  for (std::size_t at = start; at < columns.size(); at += stride) {
    const std::uint32_t candidate = columns[at];
    if (is_chosen_[candidate] != 0 || moved_[candidate] == iteration_) continue;
    const std::int32_t scored = score(candidate);
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
    if (chosen_.size() > 1) removeAt(cheapest(tabu));
    const std::uint32_t candidate = bestForRandomRow();
    if (candidate != kNone) {
      add(candidate);
      tabu = candidate;
    }
    for (const std::uint32_t row : open_) ++weight_[row];
    operations_ += open_.size();
    ++iteration_;
  }
  return smallest;
}

}  // namespace galactic::bake::sphere_fit
