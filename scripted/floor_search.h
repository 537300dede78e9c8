#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "galactic/planning_scene.h"
#include "scripted/arm.h"
#include "scripted/lattice.h"

namespace galactic::scripted {

/// Places of the base in order: each is reached from the previous one either by a turn on the spot
/// or by a straight drive, forward or backward.
using BaseRoute = std::vector<BasePlace>;

/// Finds ways for the base over the floor, with the arm in one pose: searches for the cheapest (A*,
/// Hart, Nilsson and Raphael 1968) on a lattice with eight headings and places as far apart as one
/// action drives, 5 to 10 cm; if that finds nothing, on lattices twice and three times as fine.
/// Costs are actions. Every pose that the actions lead through is checked; if actions are smaller
/// than 2 cm or 0.04 radians, only poses that far apart.
class FloorSearch {
 public:
  static constexpr std::size_t kMostBytes = std::size_t{96} << 20U;
  /// `scene` must outlive the search. `most_bytes` limits the memory of a search, and again the
  /// memory of what is remembered of earlier searches. A scene that needs more is searched as far
  /// around start and target as the memory allows; if it does not even cover the area between the
  /// two, there is no way.
  FloorSearch(PlanningScene& scene, const Robot& robot, std::size_t most_bytes = kMostBytes);

  struct Target {
    /// What the robot has to get near to; y is ignored.
    Vec3 point;
    /// The distances from the point at which the base may stand, meters.
    float nearest = 0.35F;
    float farthest = 1.0F;
    /// The side of the base that has to roughly face the point: an angle about +Y from the
    /// direction in which the base drives, radians.
    float bearing = 0;
    /// How many places are offered before the search gives up.
    int most_offers = 300;
  };
  enum class Verdict : std::uint8_t {
    kRejected,
    kAccepted,
    /// Rejected, and no other place is worth trying.
    kEnough,
  };
  /// Decides whether the robot may stop at a place of the lattice, where the wanted side roughly
  /// faces the target. May turn the place a little on the spot.
  using Judge = std::function<Verdict(BasePlace&)>;

  enum class Outcome : std::uint8_t {
    kFound,
    kNoWay,
    /// The judge accepted none of the places, of which at most `most_offers` were offered.
    kNotAccepted,
    /// The judge returned kEnough.
    kGivenUp,
  };
  struct Answer {
    Outcome outcome = Outcome::kNoWay;
    /// Without the start.
    BaseRoute route;
  };
  /// The way to the first place, in order of cost, that is accepted. `carried`: joint positions
  /// along the whole way.
  [[nodiscard]] Answer search(const BasePlace& start, const Joints& carried, const Target& target,
                              const Judge& judge);
  /// Whether the base can turn on the spot to this yaw, the shorter way round, with the current
  /// joints of the scene.
  [[nodiscard]] bool canTurn(const BasePlace& at, float to);
  [[nodiscard]] std::size_t memoryBytes() const;

 private:
  static constexpr std::uint32_t kHeadings = 8;
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;

  struct Node {
    float cost = 0;
    /// A node, or kNone for the first node after an entry.
    std::uint32_t parent = kNone;
    bool settled = false;
  };
  /// How the robot gets from its start onto the lattice.
  struct Entry {
    std::uint32_t node = 0;
    float cost = 0;
    BaseRoute route;
  };
  struct Waiting {
    float estimate = 0;
    std::uint32_t node = 0;
    friend bool operator>(const Waiting& a, const Waiting& b) {
      return a.estimate != b.estimate ? a.estimate > b.estimate : a.node > b.node;
    }
  };

  [[nodiscard]] Answer searchLattice(const BasePlace& start, const Judge& judge);
  [[nodiscard]] std::optional<Lattice> latticeAbout(const Vec3& start, float edge) const;
  /// Forgets the last search.
  void clear();
  /// Recalls what earlier searches found out about the static scene with this pose of the arm.
  void recall();
  /// Computes for every cell how many actions it is from where the robot may stand, taking doors
  /// and walls into account but not the cost of turns.
  void measureWays();
  [[nodiscard]] bool isPassable(std::uint32_t cell);
  [[nodiscard]] float targetDistance(std::uint32_t cell) const;
  [[nodiscard]] BasePlace placeOf(std::uint32_t cell, std::uint32_t fine) const;
  [[nodiscard]] std::uint32_t fineOf(float yaw) const;
  [[nodiscard]] bool isFreeOfScene(std::uint32_t cell, std::uint32_t fine);
  [[nodiscard]] bool isFree(std::uint32_t cell, std::uint32_t fine);
  /// Whether the base can turn on the spot, the shorter way round; checks both ends, too.
  [[nodiscard]] bool canTurnOnLattice(std::uint32_t cell, std::uint32_t from, std::uint32_t to);
  [[nodiscard]] bool canDrive(const BasePlace& from, const BasePlace& to);
  void findEntries(const BasePlace& start);
  void tryEntry(const BasePlace& start, std::uint32_t cell);
  void reach(std::uint32_t node, float cost, std::uint32_t parent);
  void expand(std::uint32_t node);
  void drive(std::uint32_t node, int sign);
  /// Turns the base at `node` towards the target and offers these places; if one is accepted, it is
  /// left in `stance`.
  [[nodiscard]] Verdict offer(std::uint32_t node, const Judge& judge, BasePlace& stance);
  [[nodiscard]] BaseRoute routeTo(std::uint32_t node) const;
  /// Joins successive drives along one axis.
  [[nodiscard]] BaseRoute merged(const BaseRoute& route) const;

  PlanningScene& scene_;
  std::size_t most_bytes_;
  float forward_step_;
  float turn_step_;
  /// Headings that are checked in an eighth of a turn, the actions that an eighth takes, and the
  /// headings in a full turn.
  std::uint32_t eighth_;
  float eighth_cost_;
  std::uint32_t fines_;
  // Of the current search:
  Lattice lattice_;
  const Joints* carried_ = nullptr;
  Target target_;
  float floor_ = 0;
  std::vector<Node> nodes_;
  /// Indexed by cell and fine heading: 0 unknown, 1 free, 2 blocked.
  std::vector<std::uint8_t> known_;
  /// The same for the static scene alone, which is kept between searches: for the floor of each
  /// cell, and for the robot without what it holds.
  struct Memory {
    const Scene* scene = nullptr;
    Lattice lattice;
    float floor = 0;
    Joints carried;
    std::vector<std::uint8_t> known;
    /// Indexed by cell: the same for whether any of the eight headings is free.
    std::vector<std::uint8_t> passable;
    std::vector<float> floors;

    [[nodiscard]] std::size_t bytes() const;
  };
  /// Oldest first.
  std::vector<Memory> memories_;
  std::size_t memory_ = 0;
  /// Indexed by cell and fine heading.
  std::vector<bool> offered_;
  /// Indexed by cell: see measureWays(); infinity if there is no way.
  std::vector<float> ways_;
  std::vector<Entry> entries_;
  std::vector<Waiting> waiting_;
  int offers_ = 0;
};

}  // namespace galactic::scripted
