#include "scripted/floor_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>

namespace galactic::scripted {
namespace {

constexpr float kLongestEdge = 0.1F;
/// For robots of shorter actions, searches use these limits, meters and radians: for the cells of
/// the lattice, and for the distance of the poses that are checked on the way. This keeps the time
/// and memory of a search like those of other robots.
constexpr float kShortestEdge = 0.05F;
constexpr float kFinestDrive = 0.02F;
constexpr float kFinestTurn = 0.04F;
constexpr float kInfinity = std::numeric_limits<float>::infinity();
/// Driving backward costs a little more, so that the robot sees where it goes.
constexpr float kBackwards = 1.5F;
/// How much more the remaining way counts than the way so far: a factor above 1 finds a way sooner,
/// which is longer by this factor at most.
constexpr float kHurry = 1.5F;
/// How far from its start the robot looks for the lattice, meters.
constexpr float kEntryReach = 0.25F;
/// A place this near is on the lattice already, meters.
constexpr float kOnLattice = 1e-3F;
/// Tolerance for rounding errors in numbers of actions.
constexpr float kSlack = 1e-3F;
constexpr std::uint8_t kFree = 1;
constexpr std::uint8_t kBlocked = 2;

/// The cells by which a drive of one edge along heading h advances.
struct CellStep {
  std::int32_t i = 0;
  std::int32_t k = 0;
};
constexpr std::array<CellStep, 8> kSteps{
    {{1, 0}, {1, -1}, {0, -1}, {-1, -1}, {-1, 0}, {-1, 1}, {0, 1}, {1, 1}}};

float actionsFor(float way, float step) { return std::ceil(std::fabs(way) / step - kSlack); }

}  // namespace

FloorSearch::FloorSearch(PlanningScene& scene, const Robot& robot, std::size_t most_bytes)
    : scene_(scene),
      most_bytes_(most_bytes),
      forward_step_(robot.base()->forward_step),
      turn_step_(robot.base()->turn_step),
      eighth_(static_cast<std::uint32_t>(
          std::max(actionsFor(kFullTurn / 8, std::max(turn_step_, kFinestTurn)), 1.0F))),
      eighth_cost_(std::max(actionsFor(kFullTurn / 8, turn_step_), 1.0F)),
      fines_(kHeadings * eighth_) {}

std::optional<Lattice> FloorSearch::latticeAbout(const Vec3& start, float edge) const {
  const ColumnGrid& grid = scene_.scene().grids().front();
  const ColumnGridLayout& layout = grid.layout();
  const GroundArea whole{
      layout.min_x, layout.min_x + static_cast<float>(grid.columnsX()) * grid.spacing(),
      layout.min_z, layout.min_z + static_cast<float>(grid.columnsZ()) * grid.spacing()};
  const float around = target_.farthest;
  const Vec3& end = target_.point;
  const GroundArea needed{std::min(start.x, end.x) - around, std::max(start.x, end.x) + around,
                          std::min(start.z, end.z) - around, std::max(start.z, end.z) + around};
  // known_, offered_ and ways_ come on top of the nodes.
  const std::size_t cell = kHeadings * sizeof(Node) + fines_ + fines_ / 8 + sizeof(float);
  return layOut(whole, needed, edge, most_bytes_ / cell);
}

void FloorSearch::clear() {
  nodes_.assign(lattice_.cells() * kHeadings, {kInfinity, kNone, false});
  known_.assign(lattice_.cells() * fines_, 0);
  offered_.assign(lattice_.cells() * fines_, false);
  entries_.clear();
  waiting_.clear();
  offers_ = 0;
}

BasePlace FloorSearch::placeOf(std::uint32_t cell, std::uint32_t fine) const {
  BasePlace place{lattice_.placeOf(cell),
                  wrappedAngle(kFullTurn * static_cast<float>(fine) / static_cast<float>(fines_))};
  place.position.y = memories_[memory_].floors[cell];
  return place;
}

std::uint32_t FloorSearch::fineOf(float yaw) const {
  const float share = wrappedAngle(yaw) / kFullTurn;
  const auto nearest = static_cast<std::int32_t>(std::lround(share * static_cast<float>(fines_)));
  const auto count = static_cast<std::int32_t>(fines_);
  return static_cast<std::uint32_t>((nearest + count) % count);
}

std::size_t FloorSearch::Memory::bytes() const {
  return known.size() + passable.size() + floors.size() * sizeof(float);
}

void FloorSearch::recall() {
  for (memory_ = 0; memory_ < memories_.size(); ++memory_) {
    const Memory& memory = memories_[memory_];
    const bool fits = memory.scene == &scene_.scene() && memory.lattice == lattice_ &&
                      memory.floor == floor_ && memory.carried == *carried_;
    if (fits) return;
  }
  constexpr std::size_t kMostMemories = 8;
  const std::size_t cells = lattice_.cells();
  Memory memory{&scene_.scene(),
                lattice_,
                floor_,
                *carried_,
                std::vector<std::uint8_t>(cells * fines_, 0),
                std::vector<std::uint8_t>(cells, 0),
                std::vector<float>(cells, kInfinity)};
  std::size_t bytes = memory.bytes();
  for (const Memory& other : memories_) bytes += other.bytes();
  // Oldest first.
  while (!memories_.empty() && (bytes > most_bytes_ || memories_.size() >= kMostMemories)) {
    bytes -= memories_.front().bytes();
    memories_.erase(memories_.begin());
  }
  memory_ = memories_.size();
  memories_.push_back(std::move(memory));
}

std::size_t FloorSearch::memoryBytes() const {
  std::size_t bytes = nodes_.capacity() * sizeof(Node) + known_.capacity() +
                      offered_.capacity() / 8 + ways_.capacity() * sizeof(float);
  for (const Memory& memory : memories_) bytes += memory.bytes();
  return bytes;
}

bool FloorSearch::isFreeOfScene(std::uint32_t cell, std::uint32_t fine) {
  Memory& memory = memories_[memory_];
  std::uint8_t& known = memory.known[static_cast<std::size_t>(cell) * fines_ + fine];
  if (known != 0) return known == kFree;
  float& height = memory.floors[cell];
  if (height == kInfinity) {
    const Vec3 at = placeOf(cell, fine).position;
    height = scene_.floorAt(at.x, at.z, floor_).value_or(std::numeric_limits<float>::quiet_NaN());
  }
  const bool is_free = !std::isnan(height) && scene_.isRobotFreeOfScene(placeOf(cell, fine));
  known = is_free ? kFree : kBlocked;
  return is_free;
}

bool FloorSearch::isPassable(std::uint32_t cell) {
  std::uint8_t& passable = memories_[memory_].passable[cell];
  for (std::uint32_t heading = 0; passable == 0 && heading < kHeadings; ++heading) {
    if (isFreeOfScene(cell, heading * eighth_)) passable = kFree;
  }
  if (passable == 0) passable = kBlocked;
  return passable == kFree;
}

float FloorSearch::targetDistance(std::uint32_t cell) const {
  const Vec3 way = target_.point - placeOf(cell, 0).position;
  return std::sqrt(way.x * way.x + way.z * way.z);
}

void FloorSearch::measureWays() {
  const auto cells = static_cast<std::uint32_t>(lattice_.cells());
  ways_.assign(cells, kInfinity);
  const auto push = [this](std::uint32_t cell, float way) {
    if (way >= ways_[cell] || !isPassable(cell)) return;
    ways_[cell] = way;
    waiting_.push_back({way, cell});
    std::ranges::push_heap(waiting_, std::greater<>());
  };
  for (std::uint32_t cell = 0; cell < cells; ++cell) {
    const float distance = targetDistance(cell);
    if (distance >= target_.nearest && distance <= target_.farthest) push(cell, 0);
  }
  while (!waiting_.empty()) {
    std::ranges::pop_heap(waiting_, std::greater<>());
    const Waiting at = waiting_.back();
    waiting_.pop_back();
    if (at.estimate > ways_[at.node]) continue;
    const Vec3 from = placeOf(at.node, 0).position;
    for (const CellStep& step : kSteps) {
      const auto next = lattice_.cellAt(from.x + static_cast<float>(step.i) * lattice_.edge,
                                        from.z + static_cast<float>(step.k) * lattice_.edge);
      const float length =
          step.i != 0 && step.k != 0 ? lattice_.edge * std::sqrt(2.0F) : lattice_.edge;
      if (next) push(*next, at.estimate + length / forward_step_);
    }
  }
}

bool FloorSearch::isFree(std::uint32_t cell, std::uint32_t fine) {
  std::uint8_t& known = known_[static_cast<std::size_t>(cell) * fines_ + fine];
  if (known == 0) {
    const bool is_free = isFreeOfScene(cell, fine) && scene_.isFreeOfAllElse(placeOf(cell, fine));
    known = is_free ? kFree : kBlocked;
  }
  return known == kFree;
}

bool FloorSearch::canTurnOnLattice(std::uint32_t cell, std::uint32_t from, std::uint32_t to) {
  const std::uint32_t left = (to + fines_ - from) % fines_;
  const bool goes_left = left <= fines_ / 2;
  const std::uint32_t count = goes_left ? left : fines_ - left;
  for (std::uint32_t n = 0; n <= count; ++n) {
    const std::uint32_t turned = goes_left ? n : fines_ - n;
    if (!isFree(cell, (from + turned) % fines_)) return false;
  }
  return true;
}

bool FloorSearch::canTurn(const BasePlace& at, float to) {
  const float way = wrappedAngle(to - at.yaw);
  const int looks = static_cast<int>(actionsFor(way, std::max(turn_step_, kFinestTurn)));
  for (int n = 1; n <= looks; ++n) {
    const float turned = way * (static_cast<float>(n) / static_cast<float>(looks));
    if (!scene_.isFree({at.position, at.yaw + turned})) return false;
  }
  return true;
}

bool FloorSearch::canDrive(const BasePlace& from, const BasePlace& to) {
  const Vec3 way = to.position - from.position;
  const float length = std::sqrt(way.x * way.x + way.z * way.z);
  const float apart = std::max(forward_step_, kFinestDrive);
  const int looks = static_cast<int>(actionsFor(length, apart));
  for (int n = 1; n <= looks; ++n) {
    const float share = n == looks ? 1.0F : static_cast<float>(n) * apart / length;
    BasePlace at{from.position + way * share, from.yaw};
    const std::optional<float> floor =
        scene_.floorAt(at.position.x, at.position.z, from.position.y);
    if (!floor) return false;
    at.position.y = *floor;
    if (!scene_.isFree(at)) return false;
  }
  return true;
}

void FloorSearch::tryEntry(const BasePlace& start, std::uint32_t cell) {
  if (!isFree(cell, 0) && std::isnan(memories_[memory_].floors[cell])) return;
  const BasePlace at = placeOf(cell, 0);
  const Vec3 way = at.position - start.position;
  const float length = std::sqrt(way.x * way.x + way.z * way.z);
  if (length > kEntryReach) return;
  const bool stays = length < kOnLattice;
  const float bearing = angleOf(-way.z, way.x);
  for (const float turned : {0.0F, 0.5F * kFullTurn}) {
    const float yaw = stays ? start.yaw : wrappedAngle(bearing + turned);
    const BasePlace facing{start.position, yaw};
    const BasePlace arrived{stays ? start.position : at.position, yaw};
    const std::uint32_t heading = (fineOf(yaw) + eighth_ / 2) / eighth_ % kHeadings;
    const BasePlace settled = placeOf(cell, heading * eighth_);
    if (!canTurn(start, yaw) || (!stays && !canDrive(facing, arrived))) continue;
    if (!canTurn({settled.position, yaw}, settled.yaw)) continue;
    Entry entry{cell * kHeadings + heading, 0, {}};
    entry.cost = actionsFor(wrappedAngle(yaw - start.yaw), turn_step_) +
                 actionsFor(length, forward_step_) +
                 actionsFor(wrappedAngle(settled.yaw - yaw), turn_step_);
    if (!stays) entry.route = {facing, arrived};
    entry.route.push_back({arrived.position, settled.yaw});
    entries_.push_back(std::move(entry));
    if (stays) return;
  }
}

void FloorSearch::findEntries(const BasePlace& start) {
  const auto reach_cells = static_cast<int>(std::ceil(kEntryReach / lattice_.edge));
  for (int k = -reach_cells; k <= reach_cells; ++k) {
    for (int i = -reach_cells; i <= reach_cells; ++i) {
      const auto cell = lattice_.cellAt(start.position.x + static_cast<float>(i) * lattice_.edge,
                                        start.position.z + static_cast<float>(k) * lattice_.edge);
      if (cell) tryEntry(start, *cell);
    }
  }
  for (const Entry& entry : entries_) reach(entry.node, entry.cost, kNone);
}

void FloorSearch::reach(std::uint32_t node, float cost, std::uint32_t parent) {
  Node& reached = nodes_[node];
  if (reached.settled || cost >= reached.cost) return;
  if (ways_[node / kHeadings] == kInfinity) return;
  reached.cost = cost;
  reached.parent = parent;
  waiting_.push_back({cost + kHurry * ways_[node / kHeadings], node});
  std::ranges::push_heap(waiting_, std::greater<>());
}

void FloorSearch::drive(std::uint32_t node, int sign) {
  const std::uint32_t cell = node / kHeadings;
  const std::uint32_t heading = node % kHeadings;
  const BasePlace from = placeOf(cell, heading * eighth_);
  const float x = from.position.x + static_cast<float>(sign * kSteps[heading].i) * lattice_.edge;
  const float z = from.position.z + static_cast<float>(sign * kSteps[heading].k) * lattice_.edge;
  const std::optional<std::uint32_t> next = lattice_.cellAt(x, z);
  if (!next || !isFree(*next, heading * eighth_)) return;
  const BasePlace to = placeOf(*next, heading * eighth_);
  const float length = heading % 2 == 0 ? lattice_.edge : lattice_.edge * std::sqrt(2.0F);
  // Drives along the axes are merged, so that one action takes the robot across several cells.
  const bool is_merged = heading % 2 == 0;
  const float actions = is_merged ? length / forward_step_ : actionsFor(length, forward_step_);
  if (actions > 1 + kSlack && !canDrive(from, to)) return;
  const float cost = nodes_[node].cost + (sign > 0 ? actions : kBackwards * actions);
  reach(*next * kHeadings + heading, cost, node);
}

void FloorSearch::expand(std::uint32_t node) {
  drive(node, 1);
  drive(node, -1);
  const std::uint32_t cell = node / kHeadings;
  const std::uint32_t heading = node % kHeadings;
  for (const std::uint32_t turned : {1U, kHeadings - 1}) {
    const std::uint32_t to = (heading + turned) % kHeadings;
    if (nodes_[cell * kHeadings + to].settled) continue;
    if (!canTurnOnLattice(cell, heading * eighth_, to * eighth_)) continue;
    reach(cell * kHeadings + to, nodes_[node].cost + eighth_cost_, node);
  }
}

FloorSearch::Verdict FloorSearch::offer(std::uint32_t node, const Judge& judge, BasePlace& stance) {
  const std::uint32_t cell = node / kHeadings;
  const std::uint32_t heading = node % kHeadings;
  const BasePlace place = placeOf(cell, heading * eighth_);
  const Vec3 way = target_.point - place.position;
  const float distance = targetDistance(cell);
  if (distance < target_.nearest || distance > target_.farthest) return Verdict::kRejected;
  const float facing = angleOf(-way.z, way.x) - target_.bearing;
  for (const float beside : {0.0F, 0.44F, -0.44F, 0.87F, -0.87F}) {
    const std::uint32_t fine = fineOf(facing + beside);
    const std::size_t pose = static_cast<std::size_t>(cell) * fines_ + fine;
    if (offered_[pose] || !canTurnOnLattice(cell, heading * eighth_, fine)) continue;
    offered_[pose] = true;
    ++offers_;
    stance = placeOf(cell, fine);
    const float yaw = stance.yaw;
    const Verdict verdict = judge(stance);
    // The judge may have moved the arm.
    scene_.setJoints(*carried_);
    if (verdict == Verdict::kEnough) return verdict;
    const bool is_accepted = verdict == Verdict::kAccepted;
    if (is_accepted && (stance.yaw == yaw || canTurn(place, stance.yaw))) return verdict;
  }
  return Verdict::kRejected;
}

BaseRoute FloorSearch::routeTo(std::uint32_t node) const {
  BaseRoute route;
  std::uint32_t at = node;
  while (nodes_[at].parent != kNone) {
    route.push_back(placeOf(at / kHeadings, at % kHeadings * eighth_));
    at = nodes_[at].parent;
  }
  const Entry* first = nullptr;
  for (const Entry& entry : entries_) {
    if (entry.node == at && (first == nullptr || entry.cost < first->cost)) first = &entry;
  }
  route.insert(route.end(), first->route.rbegin(), first->route.rend());
  std::ranges::reverse(route);
  return merged(route);
}

BaseRoute FloorSearch::merged(const BaseRoute& route) const {
  BaseRoute result;
  result.reserve(route.size());
  for (const BasePlace& place : route) {
    if (result.size() >= 2) {
      const BasePlace& before = result[result.size() - 2];
      const Vec3 first = result.back().position - before.position;
      const Vec3 second = place.position - result.back().position;
      const bool same_yaw = before.yaw == place.yaw && result.back().yaw == place.yaw;
      const bool along_x = std::fabs(first.z) + std::fabs(second.z) < kOnLattice;
      const bool along_z = std::fabs(first.x) + std::fabs(second.x) < kOnLattice;
      const bool goes_on = first.x * second.x + first.z * second.z > 0;
      if (same_yaw && (along_x || along_z) && goes_on) result.pop_back();
    }
    result.push_back(place);
  }
  return result;
}

FloorSearch::Answer FloorSearch::search(const BasePlace& start, const Joints& carried,
                                        const Target& target, const Judge& judge) {
  carried_ = &carried;
  target_ = target;
  floor_ = start.position.y;
  // A coarse lattice is fast; narrow doors need a finer one.
  constexpr int kFinest = 3;
  Answer answer;
  for (int pitch = 1; pitch <= kFinest; ++pitch) {
    const float edge = std::clamp(forward_step_, kShortestEdge, kLongestEdge);
    const auto lattice = latticeAbout(start.position, edge / static_cast<float>(pitch));
    // Finer lattices have even more cells.
    if (!lattice) break;
    lattice_ = *lattice;
    answer = searchLattice(start, judge);
    if (answer.outcome == Outcome::kFound || answer.outcome == Outcome::kGivenUp) break;
  }
  return answer;
}

FloorSearch::Answer FloorSearch::searchLattice(const BasePlace& start, const Judge& judge) {
  clear();
  recall();
  scene_.setJoints(*carried_);
  measureWays();
  findEntries(start);
  while (!waiting_.empty() && offers_ < target_.most_offers) {
    std::ranges::pop_heap(waiting_, std::greater<>());
    const std::uint32_t node = waiting_.back().node;
    waiting_.pop_back();
    if (nodes_[node].settled) continue;
    nodes_[node].settled = true;
    BasePlace stance;
    const Verdict verdict = offer(node, judge, stance);
    if (verdict == Verdict::kEnough) return {Outcome::kGivenUp, {}};
    if (verdict == Verdict::kAccepted) {
      Answer answer{Outcome::kFound, routeTo(node)};
      answer.route.push_back(stance);
      return answer;
    }
    expand(node);
  }
  return {offers_ == 0 ? Outcome::kNoWay : Outcome::kNotAccepted, {}};
}

}  // namespace galactic::scripted
