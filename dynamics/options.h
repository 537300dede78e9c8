#pragma once
#include <cstdint>
#include <limits>
#include <vector>

#include "dynamics/sources/body_ranges.h"
#include "dynamics/world.h"
#include "galactic/option_text.h"
#include "support/option_table.h"

namespace galactic::dynamics {

/// The user's options for a closed loop.
struct LoopOptions {
  /// Whether a policy pack takes its likeliest actions.
  bool is_deterministic = false;
  /// Seed of everything random.
  std::uint64_t seed = 1;
  /// Options of the task.
  std::vector<OptionText> task = {};
};

/// Visit each option that affects how episodes are played: the single list for the command line,
/// the journal and the report. They call on `v`
///   choice(name, field, names, help), real(name, field, Within, help), whole(name, field, Within,
///   help), sampling(field): --deterministic and --sampled, task(name, field, help).
template <class Visitor>
void visitOptions(WorldOptions& o, Visitor& v) {
  v.choice("arm", o.arm, kArmDriveNames, "What moves the arm");
  v.choice("base", o.base, kBaseDriveNames,
           "How the base goes where it is asked to: at once, or as its speeds follow");
  v.real("friction", o.friction, kFrictions,
         "Of surfaces that say nothing; that of a pair is the product");
}
template <class Visitor>
void visitOptions(LoopOptions& o, Visitor& v) {
  v.sampling(o.is_deterministic);
  v.whole("seed", o.seed, Within<std::uint64_t>{0, std::numeric_limits<std::uint64_t>::max()},
          "Of what is random in a closed loop");
  v.task("set", o.task,
         "An option of the task in a closed loop, as galactic-run has it; repeat it");
}

/// The options with their values, in the order of the visitors; numbers read back exactly. Options
/// of the task are listed under their own names.
[[nodiscard]] std::vector<OptionText> listOptions(const WorldOptions& options);
[[nodiscard]] std::vector<OptionText> listOptions(const LoopOptions& options);

}  // namespace galactic::dynamics
