#pragma once
#include <filesystem>
#include <vector>

#include "galactic/error.h"

namespace galactic::bake {

/// What an entry of a folder is, links followed.
enum class EntryKind {
  kFile,
  kFolder,
  kLostLink,  ///< A link to what is not there, or cannot be looked at.
  kOther,
};

struct FolderEntry {
  std::filesystem::path path;
  EntryKind kind = EntryKind::kOther;
  bool is_link = false;
};

/// What is in a folder, by ascending path; hidden entries, whose names begin with a dot, are left
/// out. Fails with kIo, naming the folder, where it cannot be read.
[[nodiscard]] Result<std::vector<FolderEntry>> entriesOf(const std::filesystem::path& folder);

/// What is wrong with a link to a file that is wanted; kIo.
[[nodiscard]] tl::unexpected<Error> lostLink(const std::filesystem::path& link);

/// The path with links followed, as far as it exists, and without a slash at its end.
[[nodiscard]] std::filesystem::path canonicalPath(const std::filesystem::path& path);

/// Whether `inner` is `outer` or lies in it; both canonical.
[[nodiscard]] bool liesWithin(const std::filesystem::path& inner,
                              const std::filesystem::path& outer);

}  // namespace galactic::bake
