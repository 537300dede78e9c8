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

/// A policy pack that is to be played.
struct OpenedPolicy {
  PackFile pack;
  PolicyInterface needs;
};

/// Opens RunOptions::policyFile(). Fails with the errors of PackFile::open and policyInterface.
[[nodiscard]] Result<OpenedPolicy> openPolicy(const RunOptions& options);

/// Gives the simulation the options that the policy was trained with. Fails with kInvalidInput
/// where a trusted pack has others than there are.
[[nodiscard]] Result<void> applyNeeds(const OpenedPolicy& policy, SimulationOptions& simulation);

/// The policy, ready to act: where its network wants images, it draws them by itself. `world` and
/// `simulator` must outlive it. Fails with the errors of LearnedPolicy::create and, where images
/// are wanted, with those of chooseCamera, WorldModels::from and ImageBatch::create; with
/// kInvalidInput also where noise was asked for of images that nobody draws.
[[nodiscard]] Result<std::unique_ptr<Policy>> makeLearnedPolicy(const OpenedPolicy& policy,
                                                                const World& world,
                                                                const BatchSimulator& simulator,
                                                                const RunOptions& options);

}  // namespace galactic
