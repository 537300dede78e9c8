#pragma once
#include <memory>

#include "galactic/batch_simulator.h"
#include "galactic/error.h"
#include "galactic/world.h"
#include "run/policy.h"

namespace galactic {

/// The actions of a plan, which looks at the simulator: see ScriptedPolicy. `simulator` must
/// outlive it. Fails as ScriptedPolicy::create does.
[[nodiscard]] Result<std::unique_ptr<Policy>> makePlannedPolicy(const World& world,
                                                                const BatchSimulator& simulator);

}  // namespace galactic
