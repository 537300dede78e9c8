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
  /// Everything but files that decides the result: tool and format version, kind, options, names.
  std::string key;
  /// Relative to the folder of the bake, so that a moved dataset is found again. Settled.
  ReadFiles read;
};

/// A bake that was done before.
struct CachedBake {
  /// The pack, inside the cache.
  std::filesystem::path pack;
  SourceFile digest;
  PackFigures figures;
};

/// Packs by content: a bake whose key, files and absent files are what they were is not done again,
/// whatever the files' dates. It is a folder; several processes may use it at once, and it may be
/// deleted at any time. Entries that are damaged are as if they were not there.
///
/// A result is found without knowing beforehand which files the bake would read: under each key
/// lie the results of the last bakes with the files that each read (as in ccache's manifests).
class BakeCache {
 public:
  /// Results kept for one key; the oldest make way.
  static constexpr std::size_t kResultsPerKey = 4;

  explicit BakeCache(std::filesystem::path folder) : folder_(std::move(folder)) {}

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

  /// The result for `key` whose files, seen from `folder`, are as they are now. Thread-safe.
  [[nodiscard]] std::optional<CachedBake> find(const std::string& key,
                                               const std::filesystem::path& folder,
                                               FileDigests& digests) const;

  /// Keeps the pack at `pack` (linked where the file system allows it, else copied) as the result
  /// of `inputs`. Fails with kIo. Thread-safe.
  [[nodiscard]] Result<void> store(const BakeInputs& inputs, const std::filesystem::path& pack,
                                   const PackFigures& figures) const;

 private:
  std::filesystem::path folder_;
};

/// Makes `target` the same file as `source`, or a copy where links are not possible. What was at
/// `target` is replaced in one step. Nothing is done where they are one file. Fails with kIo.
[[nodiscard]] Result<void> linkOrCopy(const std::filesystem::path& source,
                                      const std::filesystem::path& target);

}  // namespace galactic::bake
