#pragma once
#include <memory>

#include "galactic/batch_simulator.h"
#include "galactic/error.h"
#include "galactic/world.h"
#include "run/policy.h"

namespace galactic {

/// A policy that follows a plan and reads the whole state of the simulator: see ScriptedPolicy.
/// `simulator` must outlive it. Fails with the errors of ScriptedPolicy::create.
[[nodiscard]] Result<std::unique_ptr<Policy>> makePlannedPolicy(const World& world,
                                                                const BatchSimulator& simulator);

}  // namespace galactic
