#include "sphere_set/curve/exchange_search.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>

#include "galactic/bake/parallel_for.h"
#include "layout/morton.h"
#include "sphere_set/cover/candidates.h"

namespace galactic::bake::sphere_set {
namespace {

constexpr std::uint64_t kSeed = 23;
/// Number of directions in which a sphere's protrusion is sampled.
constexpr std::size_t kDirections = 48;
/// Approximate number of candidates per radius.
constexpr double kMostCandidates = 1500;
/// Farthest that a center may be outside, as a share of the radius; beyond that, most of the sphere
/// protrudes.
constexpr double kFurthestOutside = 0.25;
/// Centers are pulled deeper than necessary by this much, meters, so that rounding does not lift
/// them above the limit.
constexpr double kBelowHighest = 1e-6;
/// While gaps are wide, a sphere may protrude by tau times this power of widest gap / eps.
constexpr double kProtrusionGrowth = 0.4;
/// More than rounding takes from a sphere's reach, meters.
constexpr double kReachRounding = 1e-5;
constexpr std::size_t kChunk = 256;
constexpr std::size_t kMostExchanges = 12;
/// One of this many candidates is evaluated again after an exchange.
constexpr std::size_t kPromisingShare = 4;
/// An exchange that reduces the error by a smaller share is not worth a pass.
constexpr double kWorthwhile = 1e-3;
/// The cost, as a share of the error, that is acceptable for exchanging a sphere that protrudes
/// more than is now allowed.
constexpr double kWorthOfLimit = 0.5;
constexpr int kSweeps = 12;
/// Attempts to move a sphere in each sweep.
constexpr int kTries = 8;
/// The last step of settling as a share of the first one.
constexpr double kLastStep = 0.08;

std::array<Vec3d, kDirections> evenDirections() {
  std::array<Vec3d, kDirections> directions;
  for (std::size_t n = 0; n < kDirections; ++n) directions[n] = evenDirection(n, kDirections);
  return directions;
}

Sphere narrowed(const Vec3d& center, double radius) {
  const Vec3 c = narrow(center);
  return {c.x, c.y, c.z, static_cast<float>(radius)};
}

/// The points in the order of a Morton curve.
std::vector<Vec3d> neighborsTogether(std::span<const Vec3d> points) {
  Box box;
  for (const Vec3d& p : points) box.grow(p);
  const Vec3d size = box.size();
  constexpr double kCubes = 1U << 10U;
  const double scale = kCubes / std::max({size.x, size.y, size.z, 1e-6});
  const auto cube = [&](double from) { return static_cast<std::uint64_t>(from * scale); };
  std::vector<std::pair<std::uint64_t, std::size_t>> order;
  for (const Vec3d& p : points) {
    const Vec3d at = p - box.min;
    order.emplace_back(mortonPlace(cube(at.x), cube(at.y), cube(at.z)), order.size());
  }
  std::ranges::sort(order);
  std::vector<Vec3d> sorted;
  sorted.reserve(points.size());
  for (const auto& [place, at] : order) sorted.push_back(points[at]);
  return sorted;
}

}  // namespace

double costOfGap(const GapCost& cost, double gap) {
  if (gap <= 0) return 0;
  const double squared = gap * gap;
  return static_cast<double>(cost.linear) * gap +
         squared * (1 + static_cast<double>(cost.fourth) * squared);
}

double protrusionIntegral(const DistanceGrid& grid, const Vec3d& center, double radius) {
  static const std::array<Vec3d, kDirections> directions = evenDirections();
  double sum = 0;
  for (const Vec3d& direction : directions) {
    const double outside = std::max(0.0, grid.at(center + direction * radius));
    sum += outside * outside;
  }
  return sum * 4 * std::numbers::pi * radius * radius / static_cast<double>(kDirections);
}

ExchangeSearch::ExchangeSearch(const FitTask& task, const DistanceGrid& grid,
                               std::span<const Vec3d> points, const ErrorWeights& weights)
    : ExchangeSearch(task, grid, points, weights, {}) {
  findCandidates();
}

ExchangeSearch::ExchangeSearch(const FitTask& task, const DistanceGrid& grid,
                               std::span<const Vec3d> points, const ErrorWeights& weights,
                               std::span<const Candidate> spheres)
    : task_(task),
      grid_(grid),
      points_(neighborsTogether(points)),
      weights_(weights),
      random_(kSeed) {
  for (const Candidate& sphere : spheres) {
    chosen_.push_back({sphere, protrusionCost(sphere.center, sphere.radius_index)});
  }
  assign();
}

double ExchangeSearch::error() const {
  return sum_ * task_.solid->area() / static_cast<double>(points_.size());
}

double ExchangeSearch::protrusionCost(const Vec3d& center, std::uint32_t radius_index) const {
  // In the unit of the sum over points, in which each point stands for its share of the area.
  const double per_area = static_cast<double>(points_.size()) / task_.solid->area();
  return weights_.protrusion * per_area *
         protrusionIntegral(grid_, center, task_.radii[radius_index]);
}

void ExchangeSearch::findCandidates() {
  for (std::uint32_t radius_index = 0; radius_index < task_.radii.size(); ++radius_index) {
    for (const Candidate& found : candidatesOf(radius_index)) {
      candidates_.push_back({found, protrusionCost(found.center, radius_index)});
    }
  }
}

std::vector<std::uint32_t> ExchangeSearch::everyCandidate() const {
  std::vector<std::uint32_t> candidates(candidates_.size());
  std::iota(candidates.begin(), candidates.end(), 0U);
  return candidates;
}

std::vector<Candidate> ExchangeSearch::candidatesOf(std::uint32_t radius_index) const {
  const double radius = task_.radii[radius_index];
  const double highest = std::min(kLooserTau * task_.tau - radius, kFurthestOutside * radius);
  // A deeper sphere would not reach the surface, and a larger one is better there.
  const bool is_largest = radius_index + 1 == task_.radii.size();
  const double lowest = is_largest ? -HUGE_VAL : -radius;
  std::vector<std::size_t> nodes;
  for (std::size_t node = 0; node < grid_.nodes(); ++node) {
    const double distance = grid_.distance(node);
    if (distance <= highest + grid_.step() && distance >= lowest) nodes.push_back(node);
  }
  const std::size_t stride =
      1 + static_cast<std::size_t>(static_cast<double>(nodes.size()) / kMostCandidates);
  std::vector<Candidate> candidates;
  for (std::size_t at = 0; at < nodes.size(); at += stride) {
    const Vec3d center = asStored(grid_.position(nodes[at]));
    std::optional<Candidate> candidate;
    if (grid_.distance(nodes[at]) > highest) {
      candidate = pulledInwards(center, radius_index, highest);
    } else {
      candidate =
          Candidate{center, radius_index, std::max(0.0, grid_.distance(nodes[at]) + radius)};
    }
    if (candidate && staysAbove(task_, candidate->center, radius)) {
      candidates.push_back(*candidate);
    }
  }
  return candidates;
}

std::optional<Candidate> ExchangeSearch::pulledInwards(const Vec3d& from,
                                                       std::uint32_t radius_index,
                                                       double highest) const {
  const SurfaceDistance here = task_.solid->distance(from);
  if (here.distance == 0) return std::nullopt;
  const Vec3d outwards = (from - here.nearest) * (1 / here.distance);
  const Vec3d center = asStored(from - outwards * (here.distance - highest + kBelowHighest));
  const double there = task_.solid->distance(center, here.facet).distance;
  if (there > highest) return std::nullopt;
  return Candidate{center, radius_index, std::max(0.0, there + task_.radii[radius_index])};
}

ExchangeSearch::Place ExchangeSearch::placeOf(const Vec3d& point) const {
  // Without spheres, a point costs as much as with a sphere at the other end of the solid.
  const double furthest = norm(task_.solid->bounds().size());
  Place place{0, furthest, furthest};
  for (std::uint32_t rank = 0; rank < chosen_.size(); ++rank) {
    const Candidate& sphere = chosen_[rank].sphere;
    const double gap = norm(point - sphere.center) - task_.radii[sphere.radius_index];
    if (gap < place.gap) {
      place = {rank, gap, place.gap};
    } else {
      place.next_gap = std::min(place.next_gap, gap);
    }
  }
  return place;
}

void ExchangeSearch::assign() {
  cells_.assign(std::max<std::size_t>(1, chosen_.size()), {});
  for (auto* column : {&x_, &y_, &z_, &nearest_, &next_}) column->clear();
  std::vector<Place> places;
  std::vector<std::vector<std::uint32_t>> members(cells_.size());
  blocks_.clear();
  widest_ = 0;
  for (std::uint32_t at = 0; at < points_.size(); ++at) {
    places.push_back(placeOf(points_[at]));
    members[places.back().owner].push_back(at);
    widest_ = std::max(widest_, places.back().gap);
  }
  most_protrusion_ =
      task_.tau * std::clamp(std::pow(widest_ / task_.eps, kProtrusionGrowth), 1.0, kLooserTau);
  sum_ = 0;
  for (std::size_t rank = 0; rank < cells_.size(); ++rank) {
    fillCell(cells_[rank], members[rank], places);
    if (rank >= chosen_.size()) continue;
    cells_[rank].loss -= chosen_[rank].cost;
    sum_ += chosen_[rank].cost;
  }
  for (std::size_t rank = 0; rank < chosen_.size(); ++rank) {
    const bool is_over = chosen_[rank].sphere.protrusion > most_protrusion_;
    if (is_over) cells_[rank].loss -= kWorthOfLimit * sum_;
  }
}

void ExchangeSearch::fillCell(Cell& cell, const std::vector<std::uint32_t>& members,
                              const std::vector<Place>& places) {
  cell.first = x_.size();
  cell.first_block = blocks_.size();
  for (std::size_t at = 0; at < members.size(); at += kGainLanes) {
    addBlock(std::span(members).subspan(at, std::min(kGainLanes, members.size() - at)), places);
  }
  Box box;
  for (const std::uint32_t at : members) {
    const double nearest = costOfGap(weights_.gap, places[at].gap);
    const double next = costOfGap(weights_.gap, places[at].next_gap);
    const Vec3 p = narrow(points_[at]);
    box.grow(points_[at]);
    x_.push_back(p.x);
    y_.push_back(p.y);
    z_.push_back(p.z);
    nearest_.push_back(static_cast<float>(nearest));
    next_.push_back(static_cast<float>(next));
    sum_ += nearest;
    cell.loss += next - nearest;
    cell.widest_next = std::max(cell.widest_next, places[at].next_gap);
  }
  while (x_.size() % kGainLanes != 0) {
    for (auto* column : {&x_, &y_, &z_, &nearest_, &next_}) column->push_back(0);
  }
  cell.count = x_.size() - cell.first;
  if (members.empty()) return;
  cell.middle = (box.min + box.max) * 0.5;
  cell.radius = norm(box.size()) / 2;
}

void ExchangeSearch::addBlock(std::span<const std::uint32_t> members,
                              const std::vector<Place>& places) {
  Box box;
  double widest_next = 0;
  for (const std::uint32_t at : members) {
    box.grow(points_[at]);
    widest_next = std::max(widest_next, places[at].next_gap);
  }
  const Vec3 middle = narrow((box.min + box.max) * 0.5);
  const double reach = norm(box.size()) / 2 + widest_next + kReachRounding;
  blocks_.push_back({middle.x, middle.y, middle.z, static_cast<float>(reach)});
}

CostedPoints ExchangeSearch::pointsOf(const Cell& cell) const {
  return {&x_[cell.first],    &y_[cell.first],
          &z_[cell.first],    &nearest_[cell.first],
          &next_[cell.first], &blocks_[cell.first_block],
          cell.count};
}

ExchangeSearch::Offers ExchangeSearch::offersOf(std::uint32_t candidate) const {
  const Chosen& offered = candidates_[candidate];
  if (offered.sphere.protrusion > most_protrusion_) {
    return {{-HUGE_VAL, candidate, 0}, {-HUGE_VAL, candidate, 0}};
  }
  const double radius = task_.radii[offered.sphere.radius_index];
  const Sphere ball = narrowed(offered.sphere.center, radius);
  double added = -offered.cost;
  double instead = -HUGE_VAL;
  std::uint32_t leaves = 0;
  for (std::uint32_t rank = 0; rank < cells_.size(); ++rank) {
    const Cell& cell = cells_[rank];
    GapGain gain;
    const double least = norm(offered.sphere.center - cell.middle) - cell.radius - radius;
    if (cell.count > 0 && least < cell.widest_next) {
      gain = gain_of_(pointsOf(cell), weights_.gap, ball);
    }
    added += static_cast<double>(gain.staying);
    const double once_gone =
        static_cast<double>(gain.gone) - static_cast<double>(gain.staying) - cell.loss;
    if (once_gone > instead) {
      instead = once_gone;
      leaves = rank;
    }
  }
  return {{added, candidate, leaves}, {added + instead, candidate, leaves}};
}

std::vector<ExchangeSearch::Offers> ExchangeSearch::offersOf(
    const std::vector<std::uint32_t>& candidates) const {
  std::vector<Offers> offers(candidates.size());
  parallelFor(task_.threads, (offers.size() + kChunk - 1) / kChunk, [&](std::size_t chunk) {
    const std::size_t end = std::min(offers.size(), (chunk + 1) * kChunk);
    for (std::size_t at = chunk * kChunk; at < end; ++at) offers[at] = offersOf(candidates[at]);
  });
  return offers;
}

ExchangeSearch::Offers ExchangeSearch::best(const std::vector<Offers>& offers) {
  Offers best = offers.front();
  for (const Offers& offer : offers) {
    if (offer.added.gain > best.added.gain) best.added = offer.added;
    if (offer.exchanged.gain > best.exchanged.gain) best.exchanged = offer.exchanged;
  }
  return best;
}

std::vector<std::uint32_t> ExchangeSearch::promising(std::vector<Offers> offers) {
  std::vector<std::uint32_t> candidates;
  const auto keep = [&](Offer Offers::*which) {
    const std::size_t count = 1 + offers.size() / kPromisingShare;
    const auto end = offers.begin() + static_cast<std::ptrdiff_t>(std::min(count, offers.size()));
    std::nth_element(offers.begin(), end - 1, offers.end(), [&](const Offers& a, const Offers& b) {
      const Offer& one = a.*which;
      const Offer& other = b.*which;
      return one.gain != other.gain ? one.gain > other.gain : one.candidate < other.candidate;
    });
    for (auto at = offers.begin(); at != end; ++at) candidates.push_back((*at.*which).candidate);
  };
  keep(&Offers::added);
  keep(&Offers::exchanged);
  std::ranges::sort(candidates);
  candidates.erase(std::unique(candidates.begin(), candidates.end()), candidates.end());
  return candidates;
}

void ExchangeSearch::exchange() {
  std::vector<Offers> offers = offersOf(everyCandidate());
  next_added_ = best(offers).added.candidate;
  // A single sphere is already at its best position.
  if (chosen_.size() < 2) return;
  // A candidate that an exchange makes good was not among the worst before it.
  std::vector<std::uint32_t> candidates;
  for (std::size_t n = 0; n < kMostExchanges; ++n) {
    const Offer exchanged = best(offers).exchanged;
    if (!(exchanged.gain > kWorthwhile * sum_)) return;
    if (candidates.empty()) candidates = promising(offers);
    chosen_[exchanged.leaves] = candidates_[exchanged.candidate];
    assign();
    offers = offersOf(candidates);
    next_added_ = best(offers).added.candidate;
  }
}

bool ExchangeSearch::grow() {
  if (candidates_.empty()) return false;
  // Small moves since the last pass hardly affect which candidate is best.
  if (chosen_.empty() || !(offersOf(next_added_).added.gain > 0)) {
    const Offer added = best(offersOf(everyCandidate())).added;
    if (!(added.gain > 0)) return false;
    next_added_ = added.candidate;
  }
  chosen_.push_back(candidates_[next_added_]);
  assign();
  exchange();
  settle(kSweeps);
  return true;
}

void ExchangeSearch::cheapenProtrusion(double factor) {
  weights_.protrusion *= factor;
  for (auto* spheres : {&candidates_, &chosen_}) {
    for (Chosen& sphere : *spheres) sphere.cost *= factor;
  }
  assign();
}

double ExchangeSearch::costIn(const Cell& cell, const Chosen& chosen) const {
  if (cell.count == 0) return chosen.cost;
  const Sphere ball = narrowed(chosen.sphere.center, task_.radii[chosen.sphere.radius_index]);
  return chosen.cost - static_cast<double>(gain_of_(pointsOf(cell), weights_.gap, ball).gone);
}

void ExchangeSearch::settleOne(std::size_t rank, double step) {
  Chosen& chosen = chosen_[rank];
  const double radius = task_.radii[chosen.sphere.radius_index];
  double least = costIn(cells_[rank], chosen);
  for (int attempt = 0; attempt < kTries; ++attempt) {
    const Vec3d direction{random_.unit() * 2 - 1, random_.unit() * 2 - 1, random_.unit() * 2 - 1};
    Chosen moved = chosen;
    moved.sphere.center = asStored(chosen.sphere.center + direction * step);
    if (!staysAbove(task_, moved.sphere.center, radius)) continue;
    moved.cost = protrusionCost(moved.sphere.center, moved.sphere.radius_index);
    const double cost = costIn(cells_[rank], moved);
    if (cost >= least) continue;
    const double outside = task_.solid->distance(moved.sphere.center).distance + radius;
    if (outside > std::max(most_protrusion_, chosen.sphere.protrusion)) continue;
    moved.sphere.protrusion = std::max(0.0, outside);
    least = cost;
    chosen = moved;
  }
}

void ExchangeSearch::settle(int sweeps) {
  double step = grid_.step();
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    for (std::size_t rank = 0; rank < chosen_.size(); ++rank) settleOne(rank, step);
    assign();
    step *= std::pow(kLastStep, 1.0 / sweeps);
  }
}

std::vector<Candidate> ExchangeSearch::spheres() const {
  std::vector<Candidate> spheres;
  for (const Chosen& chosen : chosen_) spheres.push_back(chosen.sphere);
  return spheres;
}

}  // namespace galactic::bake::sphere_set
