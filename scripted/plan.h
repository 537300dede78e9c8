#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "galactic/planning_scene.h"
#include "scripted/arm_planner.h"
#include "scripted/floor_search.h"
#include "scripted/scripted_policy.h"

namespace galactic::scripted {

/// One thing to do; it may take several actions.
struct PlanStep {
  enum class Kind : std::uint8_t { kTurn, kDrive, kMoveArm, kGrasp, kRelease, kTerminate };
  Kind kind = Kind::kTurn;
  /// Where the base has to be when the step is done.
  BasePlace base;
  /// kDrive: where the line that the base follows begins, world frame, meters.
  Vec3 from;
  /// kMoveArm: where the joints have to be.
  Joints joints;
};

/// From where and how the hand reaches for the object or goal of a plan; world frame.
struct Stance {
  BasePlace base;
  /// Meters.
  Vec3 grip;
  /// The X axis of the grip.
  Vec3 approach;
};

/// What to do until the next plan; empty if there is trouble.
struct Plan {
  std::vector<PlanStep> steps;
  ScriptedTrouble trouble = ScriptedTrouble::kNone;
  /// Where the plan ends.
  Stance stance;
};

/// Drives from `start` along `route`, moves the arm along `path`, and then does `last`.
[[nodiscard]] Plan planOf(const BasePlace& start, const BaseRoute& route, const ArmPath& path,
                          PlanStep::Kind last);
/// Moves the arm before everything else, with the base at its first place.
void prepend(const BasePlace& base, const ArmPath& path, Plan& plan);
/// A plan with no steps.
[[nodiscard]] Plan troubled(ScriptedTrouble trouble);

/// A try at an episode; different tries make different plans.
struct Attempt {
  /// Number of the plan in the episode: each plan draws other random positions.
  std::uint32_t number = 0;
  /// Where earlier plans of the episode ended in failure.
  std::span<const Stance> failed;
};

}  // namespace galactic::scripted
