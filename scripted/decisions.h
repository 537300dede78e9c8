#pragma once
#include "galactic/error.h"
#include "galactic/simulation_options.h"

namespace galactic::scripted {

/// The values of the grasp and the terminate action that decide something and those that do not, by
/// the thresholds of ActionOptions.
struct Decisions {
  /// An empty hand: stays so, or closes.
  float stay_open = 0;
  float grasp = 1;
  /// A full hand: stays so, or lets go.
  float keep = 1;
  float release = -1;
  /// The episode goes on, or is over.
  float go_on = 0;
  float terminate = 1;
};

/// Fails with kUnsupported where no action decides what the task needs, or every action does.
[[nodiscard]] Result<Decisions> decisionsBy(const ActionOptions& thresholds,
                                            const TaskOptions& task);

}  // namespace galactic::scripted
