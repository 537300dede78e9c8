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

/// As JSON. BakeInputs::folder is not part of it.
[[nodiscard]] std::string encodeCacheEntry(const CacheEntry& entry);

/// None where the file cannot be read, or is not what encodeCacheEntry writes.
[[nodiscard]] std::optional<CacheEntry> readCacheEntry(const std::filesystem::path& file);

/// 32 hexadecimal digits of the content's hash.
[[nodiscard]] std::string hexOf(const SourceFile& file);

[[nodiscard]] inline bool sameContent(const SourceFile& a, const SourceFile& b) {
  return a.bytes == b.bytes && a.hash_low == b.hash_low && a.hash_high == b.hash_high;
}

}  // namespace galactic::bake
