#pragma once
#include "build/texture_checks.h"
#include "cache/bake_cache.h"
#include "cache/file_digests.h"
#include "galactic/bake/build.h"

namespace galactic::bake {

/// What the bakes of one build share.
struct BuildTools {
  BuildObserver& observer;
  /// Null where nothing is remembered.
  const BakeCache* cache = nullptr;
  FileDigests& digests;
  TextureChecks& textures;
  MemoryBudget& memory;
  const BuildOptions& options;
};

/// Makes one pack on `jobs` threads, or finds that it was made before. Tells the observer.
/// Thread-safe for different packs.
PackOutcome makePack(const PackJob& pack, unsigned jobs, const BuildTools& tools);

/// The same of a world, which is never in the cache; `linked` gets what it lists.
PackOutcome makeWorld(const PackJob& world, std::vector<LinkedPack>& linked,
                      const BuildTools& tools);

}  // namespace galactic::bake
