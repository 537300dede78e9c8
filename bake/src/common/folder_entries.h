#pragma once
#include <filesystem>
#include <vector>

#include "galactic/error.h"

namespace galactic::bake {

/// The kind of an entry in a folder, after following links.
enum class EntryKind {
  kFile,
  kFolder,
  kLostLink,  ///< A link whose target is missing or inaccessible.
  kOther,
};

struct FolderEntry {
  std::filesystem::path path;
  EntryKind kind = EntryKind::kOther;
  bool is_link = false;
};

/// The entries of a folder, by ascending path, without hidden ones (names that begin with a dot).
/// Fails with kIo, naming the folder, if it cannot be read.
[[nodiscard]] Result<std::vector<FolderEntry>> entriesOf(const std::filesystem::path& folder);

/// The error (kIo) for a link whose target is missing or inaccessible.
[[nodiscard]] tl::unexpected<Error> lostLink(const std::filesystem::path& link);

/// The path with links resolved, as far as it exists, and without a trailing slash.
[[nodiscard]] std::filesystem::path canonicalPath(const std::filesystem::path& path);

/// Whether `inner` is `outer` or lies in it. Both must be canonical.
[[nodiscard]] bool liesWithin(const std::filesystem::path& inner,
                              const std::filesystem::path& outer);

}  // namespace galactic::bake
