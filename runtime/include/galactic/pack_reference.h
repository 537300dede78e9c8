#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

#include "galactic/error.h"
#include "galactic/option_text.h"
#include "galactic/pack.h"

namespace galactic {

/// One entry in a world pack's list of packs: a view into the world pack.
struct PackReference {
  /// Relative to the folder of the world pack, '/' between parts.
  std::string_view path;
  PackKind kind = PackKind::kScene;
  /// Size of the file, and its XXH3-128 hash.
  std::uint64_t bytes = 0;
  std::uint64_t hash_low = 0;
  std::uint64_t hash_high = 0;
};

/// The list of the world pack `world`, which must outlive it, by ascending path. Fails with
/// kInvalidInput if `world` is another kind of pack.
[[nodiscard]] Result<std::vector<PackReference>> packReferences(const PackFile& world);
Result<std::vector<PackReference>> packReferences(const PackFile&& world) = delete;

/// The task options in the world pack `world`: options of OptionScope::kTask in the order of the
/// option table, each at most once, with values that setOptions() accepts. Fails with kInvalidInput
/// if `world` is another kind of pack or has other options, which is possible only if it was not
/// verified.
[[nodiscard]] Result<std::vector<OptionText>> taskOptions(const PackFile& world);

/// Where the pack of `reference` lies: beside the file that `world` was opened from.
[[nodiscard]] std::filesystem::path pathOf(const PackReference& reference, const PackFile& world);

/// Opens the pack of `reference`, which is in the list of `world`. Fails with the errors of
/// PackFile::open(), and with kInvalidInput if the file is missing or is not the one that was
/// linked: another kind, another size, or another hash (not compared with Trust::kTrusted). A
/// damaged file fails as it does when opened alone ("pack/hash"), because linking it again would
/// not help.
[[nodiscard]] Result<PackFile> openReference(const PackFile& world, const PackReference& reference,
                                             Trust trust = Trust::kVerify);

}  // namespace galactic
