#pragma once
#include <vector>

#include "galactic/planning_scene.h"
#include "scripted/arm.h"
#include "scripted/reach_table.h"

namespace galactic::scripted {

/// Poses of the arm for driving, best first: those of `table` in which the robot is slim and holds
/// things in front of it or on the side on which the arm reaches, and the robot's start pose.
/// Leaves other joints in `scene` than it found.
[[nodiscard]] std::vector<Joints> chooseCarries(PlanningScene& scene, Arm& arm,
                                                const ReachTable& table);

}  // namespace galactic::scripted
