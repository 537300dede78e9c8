#pragma once
#include <cstdint>
#include <vector>

#include "galactic/planning_scene.h"
#include "scripted/arm.h"
#include "scripted/scripted_policy.h"

namespace galactic::scripted {

/// One thing to do; it may take several actions.
struct PlanStep {
  enum class Kind : std::uint8_t { kMoveBase, kMoveArm, kGrasp, kRelease, kTerminate };
  Kind kind = Kind::kMoveBase;
  /// Where the base has to be when it is done.
  BasePlace base;
  /// kMoveArm: where the joints have to be.
  Joints joints;
};

/// What to do until the next plan; empty when there is trouble.
struct Plan {
  std::vector<PlanStep> steps;
  ScriptedTrouble trouble = ScriptedTrouble::kNone;
};

}  // namespace galactic::scripted
