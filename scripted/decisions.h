#pragma once
#include "galactic/error.h"
#include "galactic/simulation_options.h"

namespace galactic::scripted {

/// The values of the grasp and terminate actions that trigger something and those that do not,
/// given the thresholds of ActionOptions.
struct Decisions {
  /// For an empty hand: stay open, or close.
  float stay_open = 0;
  float grasp = 1;
  /// For a full hand: keep, or let go.
  float keep = 1;
  float release = -1;
  /// For the episode: go on, or end.
  float go_on = 0;
  float terminate = 1;
};

/// Fails with kUnsupported if no action, or every action, triggers something that the task needs.
[[nodiscard]] Result<Decisions> decisionsBy(const ActionOptions& thresholds,
                                            const TaskOptions& task);

}  // namespace galactic::scripted
