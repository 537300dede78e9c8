#pragma once
#include <memory>

#include "command_line/options.h"
#include "galactic/batch_simulator.h"
#include "galactic/error.h"
#include "galactic/pack.h"
#include "galactic/policy_pack.h"
#include "galactic/world.h"
#include "run/policy.h"

namespace galactic {

/// A policy pack to be played.
struct OpenedPolicy {
  PackFile pack;
  PolicyInterface needs;
};

/// Opens RunOptions::policyFile(). Fails with the errors of PackFile::open and policyInterface.
[[nodiscard]] Result<OpenedPolicy> openPolicy(const RunOptions& options);

/// Gives the simulation the options with which the policy was trained. Fails with kInvalidInput if
/// a trusted pack names options or values that do not exist.
[[nodiscard]] Result<void> applyNeeds(const OpenedPolicy& policy, SimulationOptions& simulation);

/// Makes the policy, ready to act; it draws the images that its network needs by itself. `world`
/// and `simulator` must outlive it. Fails with the errors of LearnedPolicy::create and, if it needs
/// images, with those of chooseCamera, WorldModels::from and ImageBatch::create; also with
/// kInvalidInput if noise was requested for images that nobody draws.
[[nodiscard]] Result<std::unique_ptr<Policy>> makeLearnedPolicy(const OpenedPolicy& policy,
                                                                const World& world,
                                                                const BatchSimulator& simulator,
                                                                const RunOptions& options);

}  // namespace galactic
