#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "bake_run.h"
#include "galactic/error.h"
#include "plan/plan.h"

namespace galactic::bake {

/// What became of a planned pack.
enum class PackState {
  kPlanned,    ///< Nothing: a dry run, or the run was stopped.
  kBaked,      ///< Made now.
  kUnchanged,  ///< Made before.
  kElsewhere,  ///< It belongs to another shard.
  kFailed,
};

[[nodiscard]] const char* nameOf(PackState state);

struct PackOutcome {
  std::string name;
  PackState state = PackState::kPlanned;
  /// Entry of the report of its bake, where it was baked, now or before.
  std::optional<Json> entry{};
  std::optional<Error> error{};
  double seconds = 0;
};

struct PlanOutcome {
  /// The assets of the plan in its order, then the episodes.
  std::vector<PackOutcome> packs;
  bool stopped = false;
  double seconds = 0;

  [[nodiscard]] std::size_t count(PackState state) const;
};

/// The texture packs that the bake of an entry shares with others, below the plan's folder.
[[nodiscard]] std::vector<std::string> texturePacks(const Json& entry);

}  // namespace galactic::bake
