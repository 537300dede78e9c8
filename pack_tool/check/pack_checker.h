#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "galactic/error.h"
#include "galactic/pack.h"

namespace galactic::pack_tool {

/// What is wrong with a pack: the first thing that was found. There are no warnings.
struct Finding {
  /// See findingCode.
  std::string code;
  Error error;
};

/// What became of one pack.
struct CheckedPack {
  std::string file;
  /// Nothing where the pack is good.
  std::optional<Finding> finding;
  /// Of good packs.
  PackKind kind{};
  std::size_t bytes = 0;
  /// Whether the pack lists others, and what became of these.
  bool is_world = false;
  std::vector<CheckedPack> listed;

  /// The worst exit code of the pack and those that it lists.
  [[nodiscard]] int exitCode() const;
};

/// Verifies a pack completely; of a world pack also the packs that it lists and, where all are
/// good, whether they fit together. Safe to call from several threads.
[[nodiscard]] CheckedPack checkPack(const std::filesystem::path& path);

/// A finding that concerns no pack, for example a folder without any.
[[nodiscard]] CheckedPack badPack(const std::string& file, const Error& error);

}  // namespace galactic::pack_tool
