#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "galactic/planning_scene.h"
#include "scripted/inverse_kinematics.h"
#include "support/random_stream.h"

namespace galactic::scripted {

/// Joint positions one after the other, each reached from the one before on a straight line in
/// joint space.
using ArmPath = std::vector<Joints>;

/// Moves of the arm that penetrate nothing, while the base stands still.
class ArmPlanner {
 public:
  /// `scene` and `arm` must outlive the planner.
  ArmPlanner(PlanningScene& scene, Arm& arm) : scene_(scene), arm_(arm) {}

  /// Whether the straight line in joint space is free; its beginning is not looked at.
  [[nodiscard]] bool isFree(const BasePlace& base, const Joints& from, const Joints& to);

  /// A free path, `from` left out; none when none was found. The straight line, or two trees that
  /// grow towards each other (Kuffner and LaValle, "RRT-Connect", 2000), shortened. `seed` chooses
  /// the random positions.
  [[nodiscard]] std::optional<ArmPath> plan(const BasePlace& base, const Joints& from,
                                            const Joints& to, std::uint64_t seed);

  struct Slide {
    /// How far the point moves, meters; it moves up to this, as far as it can.
    float length = 0.1F;
    /// The unit vector along which, frame of the robot's root.
    Vec3 way;
    /// Radians that the hand's direction may turn; negative: any.
    float direction_tolerance = 0.2F;
  };
  /// Moves the hand straight in space, from positions at which `hand` is fulfilled. A path of as
  /// much as is free, which may be nothing.
  [[nodiscard]] ArmPath slide(const BasePlace& base, const Joints& from, HandGoal hand,
                              const Slide& slide);

 private:
  struct Tree {
    std::vector<Joints> nodes;
    std::vector<std::uint32_t> parents;
  };
  enum class Growth : std::uint8_t { kBlocked, kGrown, kArrived };

  [[nodiscard]] std::uint32_t nearest(const Tree& tree, const Joints& to);
  /// One step from the nearest node; the new node is the last one.
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
