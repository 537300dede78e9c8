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
  /// None where nothing is remembered.
  std::optional<BakeCache> cache{};
  MemoryBudget memory{std::numeric_limits<std::uint64_t>::max()};
};

/// Makes one pack on `threads` threads, or finds that it was made before. Tells the observer.
/// Thread-safe for different packs.
PackOutcome makePack(const PackJob& pack, unsigned threads, BuildTools& tools);

/// The same of a world, which is never in the cache, and of which nobody is told; `linked` gets
/// what it lists.
PackOutcome makeWorld(const PackJob& world, BuildTools& tools, std::vector<LinkedPack>& linked);

}  // namespace galactic::bake
