#pragma once
#include <filesystem>
#include <optional>
#include <string>

#include "cache/bake_cache.h"

namespace galactic::bake {

/// What the cache remembers of one bake.
struct CacheEntry {
  BakeInputs inputs;
  /// Content of the pack.
  SourceFile pack;
  PackFigures figures;
};

/// As JSON.
[[nodiscard]] std::string encodeCacheEntry(const CacheEntry& entry);

/// None where the file cannot be read, or is not what encodeCacheEntry writes.
[[nodiscard]] std::optional<CacheEntry> readCacheEntry(const std::filesystem::path& file);

}  // namespace galactic::bake
