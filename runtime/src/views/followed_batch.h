#pragma once
#include <cstddef>
#include <cstdint>

#include "galactic/batch_simulator.h"

namespace galactic::views {

// Checks of calls that read a simulator for views. All throw ErrorException with kInvalidInput.
// `call`: the name in the message, such as "WorldViews".

/// Throws if no views can be made from `simulator` and from models with this worldHash().
void requireParts(const char* call, std::uint64_t models, const BatchSimulator& simulator);

/// Like requireParts(), but returns `models`, so that a constructor can check them before it builds
/// any member.
template <class Models>
const Models& checkedModels(const char* call, const Models& models,
                            const BatchSimulator& simulator) {
  requireParts(call, models.worldHash(), simulator);
  return models;
}

/// Throws if views of the first `envs` envs of a world with this World::hash() cannot follow
/// `simulator`.
void requireFollowed(const char* call, std::uint64_t world, const BatchSimulator& simulator,
                     std::size_t envs);

}  // namespace galactic::views
