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

/// Places of the base one after the other: each is reached from the one before either by a turn on
/// the spot or by a straight drive, forward or backward.
using BaseRoute = std::vector<BasePlace>;

/// Ways of the base over the floor, with the arm in one pose: a search for the cheapest (A*, Hart,
/// Nilsson and Raphael 1968) on a lattice of places as far apart as one action drives, 5 to 10 cm,
/// and of eight headings. Costs are actions. Every pose that the actions lead through is looked at;
/// where actions are smaller than 2 cm or 0.04 radians, only poses that far apart.
class FloorSearch {
 public:
  static constexpr std::size_t kMostBytes = std::size_t{96} << 20U;
  /// `scene` must outlive the search. `most_bytes`: of a search, and again of what is remembered of
  /// searches before. A scene that needs more is searched as far around start and target as they
  /// suffice; where they do not suffice for what lies between the two, there is no way.
  FloorSearch(PlanningScene& scene, const Robot& robot, std::size_t most_bytes = kMostBytes);

  struct Target {
    /// What the robot has to get near to; y is not looked at.
    Vec3 point;
    /// Distances of the base from it at which it may stand, meters.
    float nearest = 0.35F;
    float farthest = 1.0F;
    /// The side of the base that has to face it, more or less: an angle about +Y from the way in
    /// which the base drives, radians.
    float bearing = 0;
    /// Places that are offered before the search gives up.
    int most_offers = 300;
  };
  enum class Verdict : std::uint8_t {
    kRejected,
    kAccepted,
    /// Rejected, and no other place is worth a look.
    kEnough,
  };
  /// Whether the robot may stay at a place of the lattice, with the target on the wanted side more
  /// or less. It may turn the place a little on the spot.
  using Judge = std::function<Verdict(BasePlace&)>;

  enum class Outcome : std::uint8_t {
    kFound,
    kNoWay,
    /// No place that was offered, of all or of as many as it offers.
    kNotAccepted,
    /// The judge had enough.
    kGivenUp,
  };
  struct Answer {
    Outcome outcome = Outcome::kNoWay;
    /// Start left out.
    BaseRoute route;
  };
  /// The way to the first place, by cost, that is accepted. `carried`: positions of the joints all
  /// the way.
  [[nodiscard]] Answer search(const BasePlace& start, const Joints& carried, const Target& target,
                              const Judge& judge);
  /// Whether the base can turn on the spot to this yaw, the shorter way round, with the joints that
  /// the scene has.
  [[nodiscard]] bool canTurn(const BasePlace& at, float to);
  [[nodiscard]] std::size_t memoryBytes() const;

 private:
  static constexpr std::uint32_t kHeadings = 8;
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;

  struct Node {
    float cost = 0;
    /// A node, or kNone for the first of an entry.
    std::uint32_t parent = kNone;
    bool settled = false;
  };
  /// How the robot gets from where it is onto the lattice.
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
  /// Of the search before.
  void clear();
  /// What was found out about the static scene, with this pose of the arm, in searches before.
  void recall();
  /// How many actions every cell is from where the robot may stand, with doors and walls but with
  /// turns for nothing.
  void measureWays();
  [[nodiscard]] bool isPassable(std::uint32_t cell);
  [[nodiscard]] float targetDistance(std::uint32_t cell) const;
  [[nodiscard]] BasePlace placeOf(std::uint32_t cell, std::uint32_t fine) const;
  [[nodiscard]] std::uint32_t fineOf(float yaw) const;
  [[nodiscard]] bool isFreeOfScene(std::uint32_t cell, std::uint32_t fine);
  [[nodiscard]] bool isFree(std::uint32_t cell, std::uint32_t fine);
  /// Turning on the spot, the shorter way round; both ends are looked at.
  [[nodiscard]] bool canTurnOnLattice(std::uint32_t cell, std::uint32_t from, std::uint32_t to);
  [[nodiscard]] bool canDrive(const BasePlace& from, const BasePlace& to);
  void findEntries(const BasePlace& start);
  void tryEntry(const BasePlace& start, std::uint32_t cell);
  void reach(std::uint32_t node, float cost, std::uint32_t parent);
  void expand(std::uint32_t node);
  void drive(std::uint32_t node, int sign);
  /// Turns `node` to the target; where one of these places is accepted, `stance` is it.
  [[nodiscard]] Verdict offer(std::uint32_t node, const Judge& judge, BasePlace& stance);
  [[nodiscard]] BaseRoute routeTo(std::uint32_t node) const;
  /// With drives along one axis put together.
  [[nodiscard]] BaseRoute merged(const BaseRoute& route) const;

  PlanningScene& scene_;
  std::size_t most_bytes_;
  float forward_step_;
  float turn_step_;
  /// Headings that are looked at in an eighth of a turn, the actions that it takes, and the
  /// headings of a whole one.
  std::uint32_t eighth_;
  float eighth_cost_;
  std::uint32_t fines_;
  // Of the current search:
  Lattice lattice_;
  const Joints* carried_ = nullptr;
  Target target_;
  float floor_ = 0;
  std::vector<Node> nodes_;
  /// By cell and fine heading: 0 not known, 1 free, 2 blocked.
  std::vector<std::uint8_t> known_;
  /// The same for the static scene alone, which stays from search to search: that of the cell's
  /// floor and of the robot without what it holds.
  struct Memory {
    const Scene* scene = nullptr;
    Lattice lattice;
    float floor = 0;
    Joints carried;
    std::vector<std::uint8_t> known;
    /// By cell: the same for whether any of the eight headings is free.
    std::vector<std::uint8_t> passable;
    std::vector<float> floors;

    [[nodiscard]] std::size_t bytes() const;
  };
  /// The oldest first.
  std::vector<Memory> memories_;
  std::size_t memory_ = 0;
  /// By cell and fine heading.
  std::vector<bool> offered_;
  /// By cell: see measureWays; infinity where there is no way.
  std::vector<float> ways_;
  std::vector<Entry> entries_;
  std::vector<Waiting> waiting_;
  int offers_ = 0;
};

}  // namespace galactic::scripted
