#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "galactic/planning_scene.h"
#include "scripted/inverse_kinematics.h"
#include "support/random_stream.h"

namespace galactic::scripted {

/// Joint positions in order, each reached from the previous ones on a straight line in joint space.
using ArmPath = std::vector<Joints>;

/// Plans motions of the arm that penetrate nothing while the base stands still.
class ArmPlanner {
 public:
  /// `scene` and `arm` must outlive the planner.
  ArmPlanner(PlanningScene& scene, Arm& arm) : scene_(scene), arm_(arm) {}

  /// Whether the straight line in joint space is free; does not check its beginning.
  [[nodiscard]] bool isFree(const BasePlace& base, const Joints& from, const Joints& to);

  /// Finds a free path, which leaves out `from`; none if the search fails. The path is the straight
  /// line, or comes from two trees that grow towards each other (Kuffner and LaValle,
  /// "RRT-Connect", 2000) and is shortened. `seed` determines the random positions.
  [[nodiscard]] std::optional<ArmPath> plan(const BasePlace& base, const Joints& from,
                                            const Joints& to, std::uint64_t seed);

  struct Slide {
    /// How far the point should move, meters; it moves as far as it can, up to this.
    float length = 0.1F;
    /// Unit vector of the motion, frame of the robot's root.
    Vec3 way;
    /// How far the hand's direction may turn, radians; negative: any direction.
    float direction_tolerance = 0.2F;
  };
  /// Moves the hand in a straight line, from positions at which `hand` is fulfilled. The path
  /// covers as much as is free, and may be empty.
  [[nodiscard]] ArmPath slide(const BasePlace& base, const Joints& from, HandGoal hand,
                              const Slide& slide);

 private:
  struct Tree {
    std::vector<Joints> nodes;
    std::vector<std::uint32_t> parents;
  };
  enum class Growth : std::uint8_t { kBlocked, kGrown, kArrived };

  [[nodiscard]] std::uint32_t nearest(const Tree& tree, const Joints& to);
  /// Takes one step from the nearest node; the new node becomes the last one.
  Growth extend(const BasePlace& base, Tree& tree, const Joints& to);
  [[nodiscard]] std::optional<ArmPath> connect(const BasePlace& base, const Joints& from,
                                               const Joints& to, std::uint64_t seed);
  void shorten(const BasePlace& base, const Joints& from, ArmPath& path);

  [[nodiscard]] bool isFreeAt(const BasePlace& base, const Joints& joints);

  PlanningScene& scene_;
  Arm& arm_;
  Joints between_;
};

}  // namespace galactic::scripted
