#pragma once
#include <cstdint>
#include <vector>

#include "galactic/planning_scene.h"
#include "scripted/arm.h"
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

/// What to do until the next plan; empty when there is trouble.
struct Plan {
  std::vector<PlanStep> steps;
  ScriptedTrouble trouble = ScriptedTrouble::kNone;
};

}  // namespace galactic::scripted
