#pragma once
#include <span>

#include "galactic/batch_simulator.h"
#include "galactic/robot.h"

namespace galactic::scripted {

/// Where base and joints will be when the actions under way have arrived, if nothing deviates or
/// gets in the way (the predictor of Smith 1957). `under_way` is the result of
/// BatchSimulator::actionsUnderWay(). Everything else stays as in `state`.
[[nodiscard]] EnvState foreseen(const Robot& robot, const EnvState& state,
                                std::span<const float> under_way);

}  // namespace galactic::scripted
