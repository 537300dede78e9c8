#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cache/file_digests.h"
#include "galactic/bake/build.h"
#include "galactic/bake/read_files.h"
#include "galactic/error.h"

namespace galactic::bake {

/// What a bake depends on: its key and the files that it reads.
struct BakeInputs {
  /// Everything but the files that decides the result: tool and format version, kind, options,
  /// names.
  std::string key;
  /// Paths are relative to the folder of the bake, so that a moved dataset still matches. Settled.
  ReadFiles read;
};

/// An earlier bake.
struct CachedBake {
  /// The pack, inside the cache.
  std::filesystem::path pack;
  SourceFile digest;
  PackFigures figures;
};

/// Packs by content: a bake whose key, files and absent files are unchanged is not repeated,
/// whatever the dates of the files. The cache is a folder that several processes may use at once
/// and that may be deleted at any time. Damaged entries are ignored.
///
/// Finding a result does not require knowing which files the bake would read: each key holds the
/// results of the latest bakes together with the files that each read (like ccache's manifests).
class BakeCache {
 public:
  /// Results kept per key. The oldest are dropped.
  static constexpr std::size_t kResultsPerKey = 4;

  explicit BakeCache(std::filesystem::path folder) : folder_(std::move(folder)) {}

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

  /// The result for `key` whose files, relative to `folder`, have not changed. Thread-safe.
  [[nodiscard]] std::optional<CachedBake> find(const std::string& key,
                                               const std::filesystem::path& folder,
                                               FileDigests& digests) const;

  /// Keeps the pack at `pack` (linked if the file system allows it, else copied) as the result of
  /// `inputs`. Fails with kIo. Thread-safe.
  [[nodiscard]] Result<void> store(const BakeInputs& inputs, const std::filesystem::path& pack,
                                   const PackFigures& figures) const;

 private:
  std::filesystem::path folder_;
};

/// Makes `target` a hard link to `source`, or a copy if links are not possible. Atomically replaces
/// an existing `target`. Does nothing if the two are already the same file. Fails with kIo.
[[nodiscard]] Result<void> linkOrCopy(const std::filesystem::path& source,
                                      const std::filesystem::path& target);

}  // namespace galactic::bake
