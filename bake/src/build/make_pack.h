#pragma once
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "cache/bake_cache.h"
#include "common/memory_budget.h"
#include "galactic/bake/build.h"

namespace galactic::bake {

/// What a build makes its packs with.
struct BuildTools {
  BuildObserver& observer;
  BakeLibraries& libraries;
  bool keep_going = false;
  bool dry_run = false;
  /// None if results are not cached.
  std::optional<BakeCache> cache{};
  MemoryBudget memory{std::numeric_limits<std::uint64_t>::max()};
};

/// Makes one pack on `threads` threads, or takes it from the cache, and notifies the observer.
/// Thread-safe for different packs.
PackOutcome makePack(const PackJob& pack, unsigned threads, BuildTools& tools);

/// The same for a world, which is never cached and of which the observer is not notified. `linked`
/// receives the packs that the world lists.
PackOutcome makeWorld(const PackJob& world, BuildTools& tools, std::vector<LinkedPack>& linked);

}  // namespace galactic::bake
