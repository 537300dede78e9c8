#pragma once
#include <vector>

#include "galactic/planning_scene.h"
#include "scripted/arm.h"
#include "scripted/reach_table.h"

namespace galactic::scripted {

/// Poses of the arm for driving, the best first: those of `table` in which the robot is slim and
/// holds something in front of it or on the side on which it reaches, and its start pose. `scene`:
/// for the joints of `arm`; it has others afterwards.
[[nodiscard]] std::vector<Joints> chooseCarries(PlanningScene& scene, Arm& arm,
                                                const ReachTable& table);

}  // namespace galactic::scripted
