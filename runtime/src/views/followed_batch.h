#pragma once
#include <cstddef>

#include "galactic/batch_simulator.h"

namespace galactic::views {

/// Throws ErrorException with kInvalidInput where a simulator keeps no body transforms. `call`:
/// "WorldViews".
void requireBodies(const char* call, const BatchSimulator& simulator);

/// Throws ErrorException with kInvalidInput where a simulator is not of the batch that views were
/// made for: has fewer envs, or robots of another number of bodies.
void requireSameBatch(const char* call, const BatchSimulator& simulator, std::size_t envs,
                      std::size_t bodies);

}  // namespace galactic::views
