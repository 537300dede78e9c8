#pragma once
#include <filesystem>
#include <optional>
#include <string>

#include "cache/bake_cache.h"

namespace galactic::bake {

/// What the cache stores about one bake.
struct CacheEntry {
  BakeInputs inputs;
  /// Content of the pack.
  SourceFile pack;
  PackFigures figures;
};

/// As JSON.
[[nodiscard]] std::string encodeCacheEntry(const CacheEntry& entry);

/// None if the file cannot be read or was not written by encodeCacheEntry.
[[nodiscard]] std::optional<CacheEntry> readCacheEntry(const std::filesystem::path& file);

}  // namespace galactic::bake
