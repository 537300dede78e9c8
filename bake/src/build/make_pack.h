#pragma once
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "build/texture_checks.h"
#include "cache/bake_cache.h"
#include "cache/file_digests.h"
#include "common/memory_budget.h"
#include "galactic/bake/build.h"

namespace galactic::bake {

/// What the bakes of one build share.
struct BuildTools {
  BuildObserver& observer;
  bool keep_going = false;
  bool dry_run = false;
  /// None where nothing is remembered.
  std::optional<BakeCache> cache{};
  MemoryBudget memory{std::numeric_limits<std::uint64_t>::max()};
  FileDigests digests{};
  TextureChecks textures{};
};

/// Makes one pack on `jobs` threads, or finds that it was made before. Tells the observer.
/// Thread-safe for different packs.
PackOutcome makePack(const PackJob& pack, unsigned jobs, BuildTools& tools);

/// The same of a world, which is never in the cache, and of which nobody is told; `linked` gets
/// what it lists.
PackOutcome makeWorld(const PackJob& world, std::vector<LinkedPack>& linked);

}  // namespace galactic::bake
