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
  /// Where the base has to be when it is done.
  BasePlace base;
  /// kDrive: where the line begins to which the base keeps, world frame, meters.
  Vec3 from;
  /// kMoveArm: where the joints have to be.
  Joints joints;
};

/// From where, and how, the hand comes to what a plan is about; world frame.
struct Stance {
  BasePlace base;
  /// Meters.
  Vec3 grip;
  /// The X axis of the grip.
  Vec3 approach;
};

/// What to do until the next plan; empty when there is trouble.
struct Plan {
  std::vector<PlanStep> steps;
  ScriptedTrouble trouble = ScriptedTrouble::kNone;
  /// Where it ends.
  Stance stance;
};

/// Drives from `start` along `route`, moves the arm along `path`, and does the last.
[[nodiscard]] Plan planOf(const BasePlace& start, const BaseRoute& route, const ArmPath& path,
                          PlanStep::Kind last);
/// Moves the arm before all else, where the base stands at first.
void prepend(const BasePlace& base, const ArmPath& path, Plan& plan);
/// Nothing to do.
[[nodiscard]] Plan troubled(ScriptedTrouble trouble);

/// A try at an episode: the plans of another one are others.
struct Attempt {
  /// Counts the plans of the episode: each draws other random positions.
  std::uint32_t number = 0;
  /// Where plans of the episode have ended in vain.
  std::span<const Stance> failed;
};

}  // namespace galactic::scripted
