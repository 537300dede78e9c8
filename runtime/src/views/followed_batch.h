#pragma once
#include <cstddef>
#include <cstdint>

#include "galactic/batch_simulator.h"

namespace galactic::views {

// Of calls that read a simulator for views: all throw ErrorException with kInvalidInput. `call`:
// "WorldViews".

/// Where no views can be made of `simulator` and of models with this worldHash().
void requireParts(const char* call, std::uint64_t models, const BatchSimulator& simulator);

/// The same; returns `models`, so that no member is built before.
template <class Models>
const Models& checkedModels(const char* call, const Models& models,
                            const BatchSimulator& simulator) {
  requireParts(call, models.worldHash(), simulator);
  return models;
}

/// Where `simulator` cannot be followed by views of the first `envs` envs of a world with this
/// World::hash().
void requireFollowed(const char* call, std::uint64_t world, const BatchSimulator& simulator,
                     std::size_t envs);

}  // namespace galactic::views
