#pragma once
#include <span>

#include "galactic/batch_simulator.h"
#include "galactic/robot.h"

namespace galactic::scripted {

/// Where base and joints will be when what is under way to them has arrived, if nothing is off nor
/// in the way (the predictor of Smith 1957). `under_way`: as BatchSimulator::actionsUnderWay() has
/// it. Everything else stays as `state` has it.
[[nodiscard]] EnvState foreseen(const Robot& robot, const EnvState& state,
                                std::span<const float> under_way);

}  // namespace galactic::scripted
