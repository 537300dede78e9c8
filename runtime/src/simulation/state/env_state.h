#pragma once
#include <cstddef>
#include <string>

#include "galactic/batch_simulator.h"
#include "simulation/state/batch_state.h"
#include "simulation/state/model.h"

namespace galactic::simulation {

/// See EnvState.
[[nodiscard]] EnvObjects envObjectsOf(const Model& model, const BatchState& state,
                                      std::size_t env) noexcept;
[[nodiscard]] EnvState envStateOf(const Model& model, const BatchState& state, std::size_t env);

/// Describes what is wrong with the numbers of a state from a caller: they have to be finite and at
/// most kLargestPlain in magnitude, and rotations of unit length. Empty if nothing is wrong.
[[nodiscard]] std::string faultOfNumbers(const EnvState& state);
[[nodiscard]] std::string faultOfNumbers(const FollowedState& state);

}  // namespace galactic::simulation
